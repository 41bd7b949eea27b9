// Finds a task's trials in the frames: one row per attempt, with what the frozen list of trials
// (trial-list.csv) says of the trial.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/table.h"
#include "base/unmeasured.h"
#include "frame/frame.h"
#include "recording/session.h"
#include "task/reach_plan.h"

namespace dihaptic::analysis {

/// Finds the end of a movement's first stroke along a line: when its speed has fallen to a fifth of
/// its peak. The least peak is above noise and tremor.
class FirstStroke {
  public:
    /// `speed`: along the line [m/s]. Returns whether the stroke ends here.
    bool add(double speed) noexcept {
        peak_ = std::max(peak_, speed);
        if (over_ || peak_ < kLeastPeak || speed > kEnd * peak_) return false;
        over_ = true;
        return true;
    }

  private:
    static constexpr double kLeastPeak = 0.05;  // [m/s]
    static constexpr double kEnd = 0.2;
    double peak_ = 0;
    bool over_ = false;
};

/// Signed angle about an axis from one direction to another, both projected along the axis [rad];
/// NaN if one of them lies along it.
double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to);

/// What a row of trials.csv begins with.
struct TrialHead {
    double start = 0, end = 0;
    std::string experiment;
    std::string participant;
    int session = 1;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("start_time", f.start, "s", "in the session");
        v("stop_time", f.end, "s", "in the session");
        v("experiment", f.experiment, "", "title");
        v("ppid", f.participant, "", "participant");
        v("session_num", f.session, "1",
          "number, from 1; a session that goes on with another has the next");
    }
};

/// A trial of a session without a task.
struct PlainTrial {
    TrialHead head;
    int trial = 0;
    std::string outcome;
    double peak_grip = kUnmeasured;
    double peak_force = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        TrialHead::visit(f.head, v);
        v("trial_num", f.trial, "1", "number in the session, from 1");
        v("block_num", 1, "1", "number, from 1");
        v("trial_num_in_block", f.trial, "1", "number, from 1");
        v("outcome", f.outcome, "", "done, interrupted, diverged, or force off");
        v("peak_grip", f.peak_grip, "N", "largest grip force");
        v("peak_force", f.peak_force, "N", "largest force on any finger");
    }
};

/// What is measured in an attempt at a task's trial, in SI units.
struct TrialMeasures {
    int attempt = 0;
    std::string outcome;
    double peak_grip = kUnmeasured;
    double peak_force = 0;
    double reach_time = kUnmeasured, hand_angle = kUnmeasured, shown_angle = kUnmeasured;
    double hand_extent = kUnmeasured, shown_extent = kUnmeasured, wanted_extent = kUnmeasured;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("attempt", f.attempt, "1", "at the trial, from 1");
        v("outcome", f.outcome, "", "what ended it; interrupted: nothing did");
        v("peak_grip", f.peak_grip, "N", "largest grip force");
        v("peak_force", f.peak_force, "N", "largest force on any finger");
        v("reach_time", f.reach_time, "s", "from its start until the reach was measured");
        v("hand_angle", f.hand_angle, "deg",
          "of the handle then, from the target's direction, about the axis");
        v("shown_angle", f.shown_angle, "deg", "the same of where the handle was shown");
        v("hand_extent", f.hand_extent, "mm", "of the handle's first stroke, toward the target");
        v("shown_extent", f.shown_extent, "mm", "the same of where the handle was shown");
        v("wanted_extent", f.wanted_extent, "mm",
          "that would have led to the target, from where the handle was first shown");
    }
};

class TrialFinder {
  public:
    /// Throws Error when the session's list of trials cannot be read.
    TrialFinder(const recording::SessionFolder& folder, const std::vector<std::string>& fingers);

    void add(const frame::Frame& frame);
    Table table(const recording::SessionInfo& info) const;
    /// Number of attempts that have ended.
    size_t ended() const;

  private:
    struct Row {
        int trial = 0;
        int outcome = -1;
        double start = 0;  ///< [s]
        double end = 0;
        double share = 0;                             ///< share of the perturbation
        std::vector<frame::VariableFrame> variables;  ///< at its start [SI]
        std::vector<frame::VariableFrame> last;       ///< in its last tick
        /// At the next trial's start; they differ where something decides between trials.
        std::vector<frame::VariableFrame> decided;
        TrialMeasures measures;
        FirstStroke stroke;
        std::optional<Vec3> hand_start_W;
        Vec3 shown_start_W = Vec3::Zero();
    };
    struct Reach {
        task::ReachPlan plan;
        size_t finger = 0;
    };
    void measure_angle(Row& row, const Reach& reach, const frame::Frame& frame) const;
    void measure_extent(Row& row, const Reach& reach, const frame::Frame& frame) const;

    std::string file_;                            // trial-list.csv
    std::vector<std::vector<std::string>> list_;  // its lines, with its header
    std::vector<Reach> reaches_;                  // by trial; empty if none is measured
    std::vector<Row> rows_;
};

/// Numbers a session that resumes others after them.
void number_session(Table& own, const recording::SessionFolder& folder);
/// Puts the finished trials of the sessions that this one resumes before its own.
Table with_earlier(const Table& own, const recording::SessionFolder& folder);

/// Columns of trials.csv with their descriptions, with a task or without.
std::vector<Table::Column> trial_columns();

/// Whether the session has a task's trials.
bool has_trials(const recording::SessionFolder& folder);

}  // namespace dihaptic::analysis
