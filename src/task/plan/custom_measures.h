// Custom measures of a task (docs/measures-of-behaviour.md): expressions over recorded quantities,
// evaluated for each attempt, one frame after another.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "frame/frame.h"
#include "scene/scene.h"
#include "task/plan/taken.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::task {

/// Compiles the plan's custom measures. Its other measures must already have been checked.
void plan_custom_measures(TaskPlan& plan, Diagnostics& diagnostics);

/// Returns the columns for the custom measures and for the answers to the task's questions.
std::vector<Table::Column> columns_of(const std::vector<CustomMeasure>& measures);
std::vector<Table::Column> columns_of(const std::vector<AskSpec>& questions);

/// Computes the custom measures of successive attempts.
class CustomMeasures {
  public:
    /// `plan` must include its trials, and its custom measures must already be compiled.
    explicit CustomMeasures(TaskPlan plan);
    CustomMeasures(const CustomMeasures&) = delete;

    /// Adds a frame, which must belong to a trial attempt. The tick that ends the attempt is
    /// ignored.
    void add(const frame::Frame& frame);
    /// Ends the attempt and returns the values of its measures in the units of the columns. A value
    /// is NaN if no tick of the attempt was in the states of the measure.
    std::vector<double> end_attempt();

  private:
    void add_to_window(size_t i, double now, double value);

    TaskPlan plan_;
    TrialNumbers numbers_;
    std::vector<frame::Handle> handles_;
    std::vector<Taken> taken_;
    // times [s] and values in the moving window of each measure
    std::vector<std::deque<std::pair<double, double>>> windows_;
    int phase_ = 0;
    double entered_ = 0;  // time at which the current state was entered [s]
    double began_ = -1;   // time at which the attempt started [s]; -1 before its first frame
};

}  // namespace dihaptic::task
