// Custom measures of a task (docs/measures-of-behaviour.md): expressions over recorded quantities,
// evaluated for each attempt as its frames pass.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "frame/frame.h"
#include "scene/scene.h"
#include "task/plan/taken.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::task {

/// Compiles the custom measures for the plan, whose other measures must have been checked.
void plan_custom_measures(TaskPlan& plan, Diagnostics& diagnostics);

/// The columns of the custom measures, and of the answers to the task's questions.
std::vector<Table::Column> columns_of(const std::vector<CustomMeasure>& measures);
std::vector<Table::Column> columns_of(const std::vector<AskSpec>& questions);

/// Computes the custom measures of successive attempts.
class CustomMeasures {
  public:
    /// `plan` must include its trials, and its custom measures must have been compiled.
    explicit CustomMeasures(TaskPlan plan);
    CustomMeasures(const CustomMeasures&) = delete;

    /// `frame`: belongs to an attempt at a trial. The tick that ends the attempt is ignored.
    void add(const frame::Frame& frame);
    /// Ends the attempt and returns its values in the units of the columns; NaN if no tick of the
    /// attempt was in the measure's states.
    std::vector<double> end_attempt();

  private:
    void add_to_window(size_t i, double now, double value);

    TaskPlan plan_;
    TrialNumbers numbers_;
    std::vector<frame::Handle> handles_;
    std::vector<Taken> taken_;
    std::vector<std::deque<std::pair<double, double>>> windows_;  // times [s] and values
    int phase_ = 0;
    double entered_ = 0;  // time of entry into the state [s]
    double began_ = -1;   // start of the attempt [s]; -1: no frame yet
};

}  // namespace dihaptic::task
