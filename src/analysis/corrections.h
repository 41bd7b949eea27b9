// Finds how soon a hand corrects its movement after an event (a target or a cursor jumps, a force
// pushes): the time at which the mean velocity in trials with the event departs from the mean
// velocity in matched trials without it.
//
//     d(t)  = mean v(t) in the trials - mean v(t) in the matched ones, along an axis, from the
//             beginning of a state at t = 0 on
//     a(t)  = d'(t), by Savitzky and Golay over 50 ms
//     latency: where the line through a = 25 % and 75 % of its first peak reaches 0 (Oostwoud
//     Wijdenes, Brenner and Smeets 2014, who compared this method with others: it hardly depends on
//     how strong the correction is)
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "recording/raw_log.h"
#include "recording/session.h"
#include "rows/correction_row.h"
#include "rows/trial_row.h"
#include "task/file/task.h"

namespace dihaptic::analysis {

/// The velocities in a trial, one for each tick, from the beginning of the state.
using Velocities = std::vector<double>;

/// Finds the correction in `trials` by comparing them with `matched`. The comparison covers as much
/// time as nine tenths of the trials of each kind last, but 0.3 s to 1 s; shorter trials are left
/// out.
rows::CorrectionRow find_correction(const std::vector<const Velocities*>& trials,
                                    const std::vector<const Velocities*>& matched, double tick);

class CorrectionFinder {
  public:
    /// Returns nullopt if the session's task does not describe corrections, or if the session's
    /// files cannot be read.
    static std::optional<CorrectionFinder> of(const recording::SessionFolder& folder,
                                              const recording::LogHead& head,
                                              const std::vector<std::string>& phases);

    void add(const frame::Frame& frame);
    /// Returns one row per round, condition and perturbation, in the order of their first trials.
    /// Only the last attempt at each trial is used; practice trials are left out.
    std::vector<rows::CorrectionRow> rows() const;

  private:
    CorrectionFinder() = default;

    struct Trial {
        int attempt = 0;
        bool ended = false;
        bool whole = true;  // the velocities were recorded without a gap
        Velocities velocities;
    };

    /// The trials behind one row of the table.
    struct Group {
        std::string round, condition, perturbation;
        bool operator==(const Group&) const = default;
    };

    Trial& attempt_of(const frame::Frame& frame);
    /// Returns null if the trial is not used.
    const Velocities* velocities_of(size_t trial) const;
    /// Whether nothing happens in the trial, so that it can be compared with trials of `condition`.
    bool is_matched(const rows::AskedRow& row, const std::string& condition) const;
    /// The perturbation of the matched trials: the group's own perturbation, if the conditions of
    /// the matched trials make it harmless; otherwise none.
    std::string matched_perturbation(const Group& group) const;
    std::vector<Group> groups() const;

    task::CorrectionSpec spec_;
    std::vector<rows::AskedRow> asked_;  // one per trial
    size_t finger_ = 0;
    int phase_ = -1;
    double tick_ = 1e-3;
    std::map<int, Trial> trials_;
    int64_t sequence_ = -1;  // sequence number of the last frame
    Trial* now_ = nullptr;   // the attempt in which the state began
};

}  // namespace dihaptic::analysis
