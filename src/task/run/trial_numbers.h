// The numbers of a trial that are given as formulas in the file (docs/files.md). They are resolved
// once, at the start of the trial, from its draws, the factors of its condition, and the variables.
// The director and the hand that sees the Frames each have a TrialNumbers object of their own.
#pragma once

#include "frame/frame.h"
#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Evaluates the numbers of the current trial. TrialNumbers does not allocate after construction.
class TrialNumbers {
  public:
    /// `plan` must outlive this object.
    explicit TrialNumbers(const TaskPlan& plan);

    /// Starts an attempt. `trial` is the trial's index in the plan, and `variables` are the values
    /// of the variables [SI]. `state` is the current state, in which levels of procedures may have
    /// their standard values; if it is -1, levels have their values in `variables`.
    void begin(int trial, int attempt, std::span<const frame::VariableFrame> variables,
               int state = -1) noexcept;
    /// Starts the attempt if the trial or the attempt is new, or if the state belongs to a
    /// different interval. `trial` is counted from 1, as in frames.
    void follow(int trial, int attempt, std::span<const frame::VariableFrame> variables,
                int state) noexcept;
    /// Discards the last attempt, so that follow() starts a new one.
    void restart() noexcept { trial_ = 0; }

    const TaskPlan::Cell& cell() const noexcept { return cells_[cell_]; }
    /// Returns the value of a number in a state. (The numbers in cell() are already resolved.)
    double of(const Formula& f) const noexcept {
        return f.index < 0 ? f.value : resolved_[static_cast<size_t>(f.index)];
    }
    Vec3 of(const FormulaVec3& v) const noexcept { return {of(v[0]), of(v[1]), of(v[2])}; }
    /// Value of a formula before it is clamped to its bounds.
    double unbounded(size_t index) const noexcept { return given_[index]; }
    /// Whether the trial's block ends before the trial. `trial` is the trial's index in the plan.
    bool ends_before(int trial) noexcept;
    Quantities& quantities() noexcept { return quantities_; }
    std::span<const double> values() const noexcept { return quantities_.values(); }
    /// Sets the variables, for the expressions that use them.
    void set(std::span<const frame::VariableFrame> variables) noexcept;
    /// Sets only those variables that are answers, which change within an attempt.
    void set_answers(std::span<const frame::VariableFrame> variables) noexcept;
    /// Number of values that were outside the bounds of a formula. The next function returns the
    /// index of the last such formula, or -1 if there was none.
    int bounded() const noexcept { return bounded_; }
    int last_bounded() const noexcept { return last_bounded_; }

  private:
    double resolve(int index) noexcept;
    /// Sets the formulas in a struct to their values.
    template <class Struct>
    void resolve_in(Struct& value) noexcept {
        each_formula(value, [&](Formula& f) {
            if (f.index >= 0) f.value = resolve(f.index);
        });
    }
    void place_regions(TaskPlan::Cell& cell) noexcept;
    void place_bodies(TaskPlan::Cell& cell) noexcept;

    const TaskPlan& plan_;
    Quantities quantities_;
    Quantities between_;
    std::vector<TaskPlan::Cell> cells_;
    std::vector<double> given_;     // value of each formula, not clamped
    std::vector<double> resolved_;  // value of each formula, clamped to its bounds
    size_t cell_ = 0;
    int trial_ = 0;  // number of the trial, counted from 1; 0 if there is none yet
    int attempt_ = 0;
    bool standard_ = false;  // whether levels have their standard values
    int bounded_ = 0;
    int last_bounded_ = -1;
};

/// Calls f(index of the trial, its numbers) for each trial, with the initial values of the
/// variables, and with each level of the trial's procedure for which trials are checked before the
/// session.
template <class F>
void each_trial(const TaskPlan& plan, F f) {
    TrialNumbers numbers(plan);
    for (size_t t = 0; t < plan.trials.size(); ++t) {
        std::vector<frame::VariableFrame> variables = plan.start;
        const TaskPlan::Level* const level = plan.level_of(plan.trials[t]);
        for (size_t i = 0; i < (level == nullptr ? 1 : level->values.size()); ++i) {
            if (level != nullptr) variables[level->variable].value = level->values[i];
            numbers.begin(static_cast<int>(t), 1, variables);
            f(t, numbers);
        }
    }
}

/// Resolves the formulas of all trials, with the initial values of the variables and with procedure
/// levels at the ends of their range. Stores the largest value of each formula in the plan. Values
/// outside their bounds are reported as errors or, if variables can change them, as warnings; in
/// the latter case, the values are kept within the bounds.
void resolve_all(TaskPlan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::task
