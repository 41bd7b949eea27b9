// Computes a task's measures (task/plan/measures.h) for each trial attempt as the frames arrive.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "analysis/measures/movement.h"
#include "base/table.h"
#include "recording/raw_log.h"
#include "recording/session.h"
#include "task/plan/custom_measures.h"

namespace dihaptic::analysis {

/// Returns the columns of all measures that trials.csv may have in a session with this task: the
/// named measures, the task's custom measures, and the column that lists missing measures.
std::vector<Table::Column> measure_columns_of(const task::Task& task);

class MeasureFinder {
  public:
    /// Returns nullopt if the session's task lists no measures, or if its files cannot be read.
    static std::optional<MeasureFinder> of(const recording::SessionFolder& folder,
                                           const recording::LogHead& head,
                                           const std::vector<std::string>& phases);

    void add(const frame::Frame& frame);
    /// Ends the attempt to which the last frames belong; does nothing between trials. `lift`: null
    /// if the attempt has no lift.
    void end_attempt(const rows::LiftRow* lift);
    /// Adds the columns of the measures to a table that has the columns `trial_num` and `attempt`.
    void add_to(Table& trials) const;

  private:
    MeasureFinder() = default;
    void plan_with(const task::Task& task, const recording::SessionFolder& folder);
    MotionSample sample(const frame::Frame& frame) const;

    std::vector<const task::MeasureRow*> measures_;
    std::vector<task::CustomMeasure> custom_measures_;
    std::unique_ptr<task::CustomMeasures> own_;  // null if there are no custom measures
    task::Movement options_;
    MeasurePhases phases_;
    std::vector<task::MovementPlan> plans_;  // one per trial; empty if no measure needs them
    int finger_ = -1;  // index of the finger that moves; -1 for the body or for all fingers
    int body_ = -1;
    double tick_ = 1e-3;

    struct Row {
        int trial = 0;
        int number = 0;  // number of the attempt at the trial
        std::vector<Table::Cell> cells;
    };
    std::vector<Row> rows_;
    Attempt attempt_;
    int trial_ = 0;
    int number_ = 0;
    int64_t sequence_ = -1;  // sequence number of the last frame
};

}  // namespace dihaptic::analysis
