// A row of trials.csv: the demands and the measures of a trial attempt.
#pragma once

#include <string>

#include "base/unmeasured.h"
#include "rows/row_file.h"
#include "rows/trial_kind.h"

namespace dihaptic::rows {

/// The first columns of trials.csv.
struct TrialHead {
    double start = 0, end = 0;
    std::string experiment;
    std::string participant;
    int session = 1;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("start_time", f.start, "s", "from the session's start");
        v("stop_time", f.end, "s", "from the session's start");
        v("experiment", f.experiment, "", "title");
        v("ppid", f.participant, "", "participant");
        v("session_num", f.session, "1",
          "number, from 1; a session that resumes another continues its numbers");
    }
};

/// The demands of a trial, which are the first columns of trial-list.csv.
struct AskedRow {
    int trial = 0;  ///< 0 if the row has no number
    int block_number = 1;
    std::string block;
    int in_block = 1;
    TrialKind kind = TrialKind::baseline;
    std::string round, condition;
    std::string perturbation;
    double share = kUnmeasured;
    std::string procedure;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("trial_num", f.trial, "1", "number in the session, from 1");
        v("block_num", f.block_number, "1", "block number, from 1");
        v("block", f.block, "", "name of the block");
        v("trial_num_in_block", f.in_block, "1", "number in the block, from 1");
        v("kind", f.kind, "",
          "practice, baseline, perturbed, catch, visual_clamp, force_channel or washout");
        v("round", f.round, "", "name of the round");
        v("condition", f.condition, "", "name of the condition");
        v("perturbation", f.perturbation, "", "name, or names joined by ' + '; empty: none");
        v("share", f.share, "1",
          "share of the perturbation that acts; empty: chosen by the procedure");
        v("procedure", f.procedure, "", "name; empty: none");
    }
};

/// The measures of every attempt, in SI units. The measures of reaches are in the units of their
/// columns instead, so that every reader of the table computes exactly the same results from them.
struct TrialMeasures {
    int attempt = 0;  ///< 0 if the session has no task
    std::string outcome;
    double peak_grip = kUnmeasured;
    double peak_force = 0;
    double reach_time = kUnmeasured;
    double hand_angle_deg = kUnmeasured, shown_angle_deg = kUnmeasured;
    double hand_extent_mm = kUnmeasured, shown_extent_mm = kUnmeasured;
    double wanted_extent_mm = kUnmeasured;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("attempt", f.attempt, "1", "attempt at the trial, from 1");
        v("outcome", f.outcome, "", "outcome that ended the attempt; 'interrupted' if none did");
        v("peak_grip", f.peak_grip, "N", "largest grip force");
        v("peak_force", f.peak_force, "N", "largest force on any finger");
        v("reach_time", f.reach_time, "s",
          "time from the attempt's start until the reach was measured");
        v("hand_angle_deg", f.hand_angle_deg, "deg",
          "direction error of the handle when the reach was measured, from the target's direction, "
          "about the axis");
        v("shown_angle_deg", f.shown_angle_deg, "deg",
          "the same direction error of the displayed handle");
        v("hand_extent_mm", f.hand_extent_mm, "mm",
          "length of the handle's first stroke, toward the target");
        v("shown_extent_mm", f.shown_extent_mm, "mm",
          "length of the displayed handle's first stroke");
        v("wanted_extent_mm", f.wanted_extent_mm, "mm",
          "length that would have led to the target, from the handle's first displayed position");
    }
};
/// The outcome of an attempt that ended without any other outcome.
inline constexpr const char* kInterrupted = "interrupted";

/// An attempt at a trial of a task. Variables, levels, answers and the task's custom measures are
/// in further columns, which differ between tasks (RowFile::column).
struct TrialRow {
    TrialHead head;
    AskedRow asked;
    TrialMeasures measures;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        TrialHead::visit(f.head, v);
        AskedRow::visit(f.asked, v);
        TrialMeasures::visit(f.measures, v);
    }
};

/// A trial of a session without a task.
struct PlainTrialRow {
    TrialHead head;
    int trial = 0;
    int block = 1;
    std::string outcome;
    double peak_grip = kUnmeasured;
    double peak_force = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        TrialHead::visit(f.head, v);
        v("trial_num", f.trial, "1", "number in the session, from 1");
        v("block_num", f.block, "1", "block number, from 1");
        v("trial_num_in_block", f.trial, "1", "number in the block, from 1");
        v("outcome", f.outcome, "", "done, interrupted, diverged, or force off");
        v("peak_grip", f.peak_grip, "N", "largest grip force");
        v("peak_force", f.peak_force, "N", "largest force on any finger");
    }
};

using TrialFile = RowFile<TrialRow>;

}  // namespace dihaptic::rows
