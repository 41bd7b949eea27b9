// Measures of a task's own (docs/measures-of-behaviour.md): expressions over what is recorded,
// taken of each attempt while its frames go by.
#pragma once

#include <vector>

#include "frame/frame.h"
#include "scene/scene.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::task {

/// Compiles the task's own measures for its plan. The plan must have its other measures checked.
void plan_own_measures(TaskPlan& plan, Diagnostics& diagnostics);

/// The columns of the task's own measures.
std::vector<Table::Column> columns_of(const std::vector<OwnMeasure>& measures);

/// Takes the own measures of one attempt after the other.
class OwnMeasures {
  public:
    /// `plan`: with its trials; its own measures must have been compiled.
    explicit OwnMeasures(TaskPlan plan);
    OwnMeasures(const OwnMeasures&) = delete;

    /// `frame`: of an attempt at a trial.
    void add(const frame::Frame& frame);
    /// In the units of the columns; NaN where no tick of the attempt was in the measure's states.
    /// What follows is another attempt.
    std::vector<double> end_attempt();

  private:
    struct Taken {
        double value = 0;
        int64_t ticks = 0;
    };
    TaskPlan plan_;
    TrialNumbers numbers_;
    std::vector<frame::Handle> handles_;
    std::vector<Taken> taken_;
    int phase_ = 0;
    double entered_ = 0;  // the state [s]
    double began_ = -1;   // the attempt [s]; -1: it has no frame yet
};

}  // namespace dihaptic::task
