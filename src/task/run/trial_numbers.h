// The numbers of a trial that are formulas in the file (docs/files.md): resolved once, at the
// trial's start, from its draws, its condition's factors and the variables. The director and the
// hand that sees the Frames each have a separate object.
#pragma once

#include "frame/frame.h"
#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Evaluates the numbers of the current trial. Once constructed, it allocates nothing.
class TrialNumbers {
  public:
    /// `plan` must outlive the object.
    explicit TrialNumbers(const TaskPlan& plan);

    /// `trial`: index in the plan. `variables`: values of the variables [SI]. `state`: current
    /// state, in which levels of procedures may have their standard; -1: they have their values in
    /// the variables.
    void begin(int trial, int attempt, std::span<const frame::VariableFrame> variables,
               int state = -1) noexcept;
    /// Starts the attempt if it is a new attempt at a trial, or if the state belongs to another
    /// interval. `trial`: from 1, as in frames.
    void follow(int trial, int attempt, std::span<const frame::VariableFrame> variables,
                int state) noexcept;
    /// Forgets the last attempt.
    void restart() noexcept { trial_ = 0; }

    const TaskPlan::Cell& cell() const noexcept { return cells_[cell_]; }
    /// The value of a state's number. The numbers in cell() already have their values.
    double of(const Formula& f) const noexcept {
        return f.index < 0 ? f.value : resolved_[static_cast<size_t>(f.index)];
    }
    Vec3 of(const FormulaVec3& v) const noexcept { return {of(v[0]), of(v[1]), of(v[2])}; }
    /// Value of a formula before it is limited to its bounds.
    double unbounded(size_t index) const noexcept { return given_[index]; }
    /// Whether the trial's block ends before the trial. `trial`: index in the plan.
    bool ends_before(int trial) noexcept;
    Quantities& quantities() noexcept { return quantities_; }
    std::span<const double> values() const noexcept { return quantities_.values(); }
    /// Sets the variables for the expressions that use them.
    void set(std::span<const frame::VariableFrame> variables) noexcept;
    /// Sets only the answers among the variables, which change within an attempt.
    void set_answers(std::span<const frame::VariableFrame> variables) noexcept;
    /// Number of values outside the bounds of a formula, and index of the last such formula; -1:
    /// none.
    int bounded() const noexcept { return bounded_; }
    int last_bounded() const noexcept { return last_bounded_; }

  private:
    double resolve(int index) noexcept;
    /// Sets the formulas of a struct to their values.
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
    std::vector<double> given_;     // by formula
    std::vector<double> resolved_;  // by formula, within its bounds
    size_t cell_ = 0;
    int trial_ = 0;  // from 1; 0: none yet
    int attempt_ = 0;
    bool standard_ = false;  // levels have their standard values
    int bounded_ = 0;
    int last_bounded_ = -1;
};

/// Calls f(index of the trial, its numbers) for each trial with the initial variables, and with
/// each level of its procedure at which trials are checked before the session.
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

/// Resolves the formulas of all trials with the initial variables, and with levels of procedures at
/// the ends of their range. Stores their largest values in the plan, and reports values outside
/// their bounds as errors, or as warnings if variables can change them; such values are then kept
/// within the bounds.
void resolve_all(TaskPlan& plan, Diagnostics& diagnostics);

}  // namespace dihaptic::task
