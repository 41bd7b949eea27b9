// Finds the trials of a task in the frames. Makes one row per attempt, which includes the trial's
// entries in the frozen list of trials (trial-list.csv).
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/table.h"
#include "frame/frame.h"
#include "recording/session.h"
#include "rows/trial_row.h"
#include "task/plan/reach_plan.h"

namespace dihaptic::analysis {

/// Finds the end of a movement's first stroke along a line, i.e. when the speed has fallen to a
/// fifth of its peak. The minimum peak speed is above noise and tremor.
class FirstStroke {
  public:
    /// Adds a sample. `speed`: speed along the line [m/s]. Returns whether the stroke ends with
    /// this sample.
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

/// Signed angle about an axis from one direction to another, both projected onto the plane
/// perpendicular to the axis [rad]; NaN if either direction is parallel to the axis.
double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to);

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
        std::vector<frame::VariableFrame> variables;  ///< values at the start of the trial [SI]
        std::vector<frame::VariableFrame> last;       ///< values in the last tick of the trial
        /// Values at the start of the next trial. These differ from the values in the last tick if
        /// a program sets them after the trial.
        std::vector<frame::VariableFrame> decided;
        rows::TrialMeasures measures;
        FirstStroke stroke;
        std::optional<Vec3> hand_start_W;
        Vec3 shown_start_W = Vec3::Zero();
    };
    struct Reach {
        task::ReachPlan plan;
        size_t finger = 0;
        std::vector<int> phases;
    };
    void measure_angle(Row& row, const Reach& reach, const frame::Frame& frame) const;
    void measure_extent(Row& row, const Reach& reach, const frame::Frame& frame) const;

    std::string file_;                            // trial-list.csv
    std::vector<std::vector<std::string>> list_;  // lines of trial-list.csv, including the header
    std::vector<Reach> reaches_;                  // one per trial; empty if no reach is measured
    std::vector<Row> rows_;
};

/// Number of the last of the sessions that this session resumes; 0 if it resumes none.
int sessions_before(const recording::SessionFolder& folder);
/// Numbers a session's trials after those of the sessions that it resumes.
void number_session(Table& own, const recording::SessionFolder& folder);
/// Inserts the finished trials of the sessions that this session resumes before the session's own
/// trials.
Table with_earlier(const Table& own, const recording::SessionFolder& folder);

/// The column of a variable, of the level of a procedure, or of an answer.
struct NumberColumn : Table::Column {
    bool known_before = true;  ///< whether the value is known before the trial
};
/// Returns the columns of this kind in a session, in the order of trials.csv.
std::vector<NumberColumn> columns_of_numbers(const recording::SessionInfo& info);

/// Column of trials.csv in a task for two people.
inline const Table::Column kPartnerColumn{"partner", "second participant of a task for two"};

/// Returns the columns of trials.csv with their descriptions, whether or not the session has a
/// task.
std::vector<Table::Column> trial_columns();

/// Whether the session has a task with trials.
bool has_trials(const recording::SessionFolder& folder);

}  // namespace dihaptic::analysis
