#include "task/run/trial_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/unmeasured.h"

namespace dihaptic::task {
namespace {

double within(const Field& field, double value) noexcept {
    const double least = field.above_min ? std::nextafter(field.min, field.max) : field.min;
    return std::isnan(value) ? least : std::clamp(value, least, field.max);
}

/// Stores the formula's value in the trial, and reports a value that is out of bounds.
void look_at(int index, size_t trial, const TrialNumbers& numbers, TaskPlan& plan,
             std::vector<char>& told, Diagnostics& diagnostics) {
    const auto i = static_cast<size_t>(index);
    CompiledFormula& compiled = plan.formulas[i];
    const Formula& f = compiled.formula;
    const double given = numbers.unbounded(i);
    compiled.largest = std::max(compiled.largest, within(f.field, given));
    if (within(f.field, given) == given || told[i]) return;
    told[i] = 1;
    if (std::isnan(given)) {
        diagnostics.error(f.place, f.key,
                          fmt::format("'{}' has no value in trial {}", f.text, trial + 1),
                          "Use quantities that are already known: a region can use regions that "
                          "are listed before it.");
        return;
    }
    const auto say = fmt::format("'{}' gives {:.6g} in trial {}, but must be {} {:.6g} {} {:.6g}",
                                 f.text, given / f.to_si, trial + 1,
                                 f.field.above_min ? "above" : "from", f.field.min / f.to_si,
                                 f.field.above_min ? "and at most" : "to", f.field.max / f.to_si);
    if (compiled.expression.foreseen()) {
        diagnostics.error(f.place, f.key, say, "Correct the formula or the quantities in it.");
    } else {
        diagnostics.warning(
            f.place, f.key, say,
            "The value is kept within these bounds; clamp() would make this explicit in the file.");
    }
}

}  // namespace

TrialNumbers::TrialNumbers(const TaskPlan& plan)
    : plan_(plan),
      quantities_(plan.quantities),
      between_(plan.between),
      cells_(plan.cells),
      given_(plan.formulas.size()),
      resolved_(plan.formulas.size()) {}

double TrialNumbers::resolve(int index) noexcept {
    const auto i = static_cast<size_t>(index);
    const CompiledFormula& formula = plan_.formulas[i];
    given_[i] = formula.value(quantities_.values());
    resolved_[i] = within(formula.formula.field, given_[i]);
    if (resolved_[i] != given_[i]) {
        ++bounded_;
        last_bounded_ = index;
    }
    return resolved_[i];
}

void TrialNumbers::set(std::span<const frame::VariableFrame> variables) noexcept {
    const auto& symbols = plan_.symbols.variables;
    for (size_t i = 0; i < std::min(variables.size(), symbols.size()); ++i) {
        quantities_.set(symbols[i].slot, variables[i].value);
        between_.set(symbols[i].between, variables[i].value);
    }
}

void TrialNumbers::set_answers(std::span<const frame::VariableFrame> variables) noexcept {
    const auto& symbols = plan_.symbols.variables;
    const size_t first = plan_.task.variables.size() + plan_.levels.size();
    for (size_t i = first; i < std::min(variables.size(), symbols.size()); ++i)
        quantities_.set(symbols[i].slot, variables[i].value);
}

bool TrialNumbers::ends_before(int trial) noexcept {
    const Trial& next = plan_.trials[static_cast<size_t>(trial)];
    const auto& until = plan_.until[static_cast<size_t>(next.block)];
    between_.set(Quantities::kTrial, trial + 1);
    return until && (*until)(between_.values()) != 0;
}

void TrialNumbers::begin(int trial, int attempt, std::span<const frame::VariableFrame> variables,
                         int state) noexcept {
    trial_ = trial + 1;
    attempt_ = attempt;
    const Trial& now = plan_.trials[static_cast<size_t>(trial)];
    const Symbols& symbols = plan_.symbols;
    for (size_t i = 0; i < symbols.draws.size(); ++i)
        quantities_.set(symbols.draws[i].slot, symbols.draws[i].value(now.draws[i]));
    for (const Symbols::Levels& factor : symbols.factors) {
        const int of = factor.of_round ? now.round : now.condition;
        quantities_.set(factor.slot, factor.levels[static_cast<size_t>(of)]);
    }
    quantities_.set(Quantities::kTimeInState, 0);
    quantities_.set(Quantities::kTimeInTrial, 0);
    quantities_.set(Quantities::kTrial, trial_);
    quantities_.set(Quantities::kAttempt, attempt_);
    set(variables);
    standard_ = plan_.shows_standard(now, state);
    for (const TaskPlan::Level& level : plan_.levels) {
        if (standard_) quantities_.set(symbols.variables[level.variable].slot, level.standard);
    }
    cell_ = plan_.cell_index(now);
    TaskPlan::Cell& cell = cells_[cell_];
    // values that are not known yet are detected when all trials are resolved before the session
    for (size_t i = 0; i < cell.p_W.size(); ++i)
        quantities_.set(quantities_.region(i), Vec3::Constant(kUnmeasured));
    for (const TaskPlan::StartPose& start_pose : cell.start_poses)
        quantities_.set(quantities_.start(static_cast<size_t>(start_pose.body)),
                        Vec3::Constant(kUnmeasured));
    place_regions(cell);
    place_bodies(cell);
    for (Perturbation& perturbation : cell.perturbations) resolve_in(perturbation);
    for (const int index : plan_.in_states) resolve(index);
}

void TrialNumbers::place_regions(TaskPlan::Cell& cell) noexcept {
    for (size_t i = 0; i < cell.regions.size(); ++i) {
        Region& region = cell.regions[i];
        resolve_in(region);
        cell.p_W[i] = value(region.position);
        quantities_.set(quantities_.region(i), cell.p_W[i]);
        quantities_.set(quantities_.region(i) + 3, region.radius.value);
    }
}

void TrialNumbers::place_bodies(TaskPlan::Cell& cell) noexcept {
    for (TaskPlan::StartPose& start_pose : cell.start_poses) {
        resolve_in(start_pose);
        if (start_pose.joint) {
            const auto first = std::find_if(cell.start_poses.begin(), cell.start_poses.end(),
                                            [&](const TaskPlan::StartPose& other) {
                                                return other.body == start_pose.joint->first;
                                            });
            const bool placed = first != cell.start_poses.end();
            const Pose X_WA = placed ? first->X_WB : start_pose.joint->X_WA;
            start_pose.X_WB = start_pose.joint->pose(X_WA, start_pose.coordinate.value);
            start_pose.motion =
                start_pose.joint->motion(X_WA, placed ? first->motion : BodyMotion{},
                                         start_pose.X_WB, start_pose.rate.value);
        } else {
            start_pose.X_WB.p = value(start_pose.position);
            start_pose.motion.v = value(start_pose.velocity);
        }
        quantities_.set(quantities_.start(static_cast<size_t>(start_pose.body)), start_pose.X_WB.p);
    }
}

void TrialNumbers::follow(int trial, int attempt, std::span<const frame::VariableFrame> variables,
                          int state) noexcept {
    if (trial < 1) return;
    const bool standard = plan_.shows_standard(plan_.trials[static_cast<size_t>(trial - 1)], state);
    if (trial == trial_ && attempt == attempt_ && standard == standard_) return;
    begin(trial - 1, attempt, variables, state);
}

void resolve_all(TaskPlan& plan, Diagnostics& diagnostics) {
    if (plan.formulas.empty()) return;
    std::vector<char> told(plan.formulas.size(), 0);
    each_trial(plan, [&](size_t t, const TrialNumbers& numbers) {
        for (const int index : plan.used_in(plan.trials[t]))
            look_at(index, t, numbers, plan, told, diagnostics);
    });
}

}  // namespace dihaptic::task
