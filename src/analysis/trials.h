// Finds a task's trials in the frames: one row per attempt, with what the frozen list of trials
// (trial-list.csv) says of the trial.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/table.h"
#include "recording/session.h"
#include "servo/frame.h"

namespace dihaptic::analysis {

/// How one trial's reach is measured.
struct ReachPlan {
    size_t finger = 0;
    int phase = 0;               ///< phase in which it is measured
    double distance = 0;         ///< distance from from_W at which the angle is measured [m]
    Vec3 from_W = Vec3::Zero();  ///< [m]
    Vec3 to_W = Vec3::Zero();
    Vec3 axis_W = Vec3::UnitZ();  ///< axis of the angles; unit vector
    bool extent = false;          ///< the extent is measured, in place of the angle
};

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

class TrialFinder {
  public:
    /// Throws Error when the session's list of trials cannot be read.
    TrialFinder(const recording::SessionFolder& folder, const std::vector<std::string>& fingers);

    void add(const servo::Frame& frame);
    Table table(const recording::SessionInfo& info) const;

  private:
    struct Row {
        int trial = 0;
        int attempt = 0;
        int outcome = -1;
        double start = 0;  ///< [s]
        double end = 0;
        double share = 0;  ///< share of the perturbation
        double peak_grip;
        double peak_force = 0;
        double hand_angle;  ///< [rad]
        double shown_angle;
        double reach_time;   ///< when the handle was at `distance`, or its first stroke ended [s]
        double hand_extent;  ///< [m]
        double shown_extent;
        double wanted_extent;  ///< from where the handle was first shown
        FirstStroke stroke;
        std::optional<Vec3> hand_start_W;
        Vec3 shown_start_W = Vec3::Zero();
    };
    void measure_angle(Row& row, const ReachPlan& reach, const servo::Frame& frame) const;
    void measure_extent(Row& row, const ReachPlan& reach, const servo::Frame& frame) const;

    std::vector<std::vector<std::string>> list_;  // trial-list.csv, with its header
    std::vector<ReachPlan> reaches_;              // by trial; empty if none is measured
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
