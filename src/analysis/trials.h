// Trials of a task, told from the frames: one row for each attempt, with what the frozen list of
// trials (trial-list.csv) says of it.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/table.h"
#include "recording/session.h"
#include "servo/frame.h"

namespace dihaptic::analysis {

/// Where a reach is measured, of one trial.
struct ReachPlan {
    size_t finger = 0;
    int phase = 0;               ///< in which it is measured
    double distance = 0;         ///< from its beginning [m]
    Vec3 from_W = Vec3::Zero();  ///< [m]
    Vec3 to_W = Vec3::Zero();
    Vec3 axis_W = Vec3::UnitZ();  ///< that angles are about; unit
    bool extent = false;          ///< is measured, in place of the angle
};

/// The first stroke of a movement along a line: over once its speed has fallen to a fifth of its
/// peak, which noise and tremor do not reach.
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

/// Signed angle about an axis from one direction to another, both seen along the axis [rad]; NaN
/// where one of them lies along it.
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
        double share = 0;  ///< of the perturbation
        double peak_grip;
        double peak_force = 0;
        double hand_angle;  ///< [rad]
        double shown_angle;
        double reach_time;   ///< when the handle was so far, or its first stroke ended [s]
        double hand_extent;  ///< [m]
        double shown_extent;
        double wanted_extent;  ///< from where the handle was shown first
        FirstStroke stroke;
        std::optional<Vec3> hand_start_W;
        Vec3 shown_start_W = Vec3::Zero();
    };
    void measure_angle(Row& row, const ReachPlan& reach, const servo::Frame& frame) const;
    void measure_extent(Row& row, const ReachPlan& reach, const servo::Frame& frame) const;

    std::vector<std::vector<std::string>> list_;  // trial-list.csv, its header first
    std::vector<ReachPlan> reaches_;              // by trial; empty: none are measured
    std::vector<Row> rows_;
};

/// A session that goes on with others has the number after theirs.
void number_session(Table& own, const recording::SessionFolder& folder);
/// Puts the finished trials of the sessions that this one goes on with before its own.
Table with_earlier(const Table& own, const recording::SessionFolder& folder);

/// Columns of trials.csv, with a task or without, and what each is.
std::vector<Table::Column> trial_columns();

/// Whether the session's trials are a task's.
bool has_trials(const recording::SessionFolder& folder);

}  // namespace dihaptic::analysis
