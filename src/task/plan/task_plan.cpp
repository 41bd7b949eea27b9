#include "task/plan/task_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/plural.h"
#include "base/unmeasured.h"
#include "rows/procedure_row.h"
#include "task/plan/cell_planner.h"
#include "task/plan/check_blocks.h"
#include "task/plan/custom_measures.h"
#include "task/plan/factors.h"
#include "task/plan/levels.h"
#include "task/plan/plan_formulas.h"
#include "task/plan/reach_plan.h"
#include "task/plan/state_planner.h"
#include "task/run/clearance.h"

namespace dihaptic::task {
namespace {

/// Returns the text shown while a finger is in the way of an object, which says how far the finger
/// has to move.
std::string move_away(const scene::Scene& scene) {
    double most = 0;
    for (const scene::Finger& finger : scene.fingers) most = std::max(most, reach_of(finger));
    return fmt::format("Take the hands off the objects, {:.0f} mm away",
                       std::ceil(1e3 * (most + kClearance)));
}

void check_lists(const Task& task, Diagnostics& diagnostics) {
    check_names(task.hands, "hands", diagnostics);
    check_names(task.regions, "regions", diagnostics);
    check_names(task.perturbations, "perturbations", diagnostics);
    check_names(task.sounds, "sounds", diagnostics);
    check_names(task.states, "states", diagnostics);
    check_names(task.conditions, "conditions", diagnostics);
    check_names(task.draws, "draws", diagnostics);
    check_names(task.variables, "variables", diagnostics);
    check_names(task.rounds, "rounds", diagnostics);
    check_names(task.procedures, "procedures", diagnostics);
    check_names(task.blocks, "blocks", diagnostics);
    if (task.regions.size() > frame::TaskFrame::kMostTargets) {
        diagnostics.error(task.place, "regions",
                          fmt::format("there are {}, but at most {} are allowed",
                                      task.regions.size(), frame::TaskFrame::kMostTargets),
                          "Use a single region whose position depends on the condition.");
    }
    if (task.sounds.size() > TaskPlan::kMostSounds)
        diagnostics.error(task.sounds.back().place, "sounds",
                          fmt::format("there are {}, but at most {} are allowed",
                                      task.sounds.size(), TaskPlan::kMostSounds),
                          "Leave out those that no state needs.");
    if (task.states.empty())
        diagnostics.error(task.place, "states", "there are none", "Add at least one.");
    if (task.states.size() > TaskPlan::kMostStates)
        diagnostics.error(task.place, "states",
                          fmt::format("there are more than {}", TaskPlan::kMostStates), "");
    if (task.blocks.empty())
        diagnostics.error(task.place, "blocks", "there are none",
                          "Add at least one, with its trials.");
}

/// Plans a task part by part. Each part may refer only to parts that have already been planned.
class Planner : Planning {
  public:
    explicit Planner(const Planning& given) : Planning(given), seen_(given), bodies_(given) {}

    void plan_all() {
        name_quantities();
        for (const auto* list : {&plan.task.conditions, &plan.task.rounds}) {
            for (const Condition& condition : *list) check_condition(condition);
        }
        if (has_intervals(plan.task))
            plan.comparison = look_up(names_of(plan.task.draws), kComparisonInterval,
                                      plan.task.place, "draws", "not a draw", diagnostics);
        plan_formulas(plan, diagnostics);
        plan.move_away = seen_.text(move_away(scene), plan.task.place, "message");
        plan_sounds();
        plan_states(*this, bodies_, seen_);
        plan_cells(*this, bodies_, seen_);
        seen_.plan_task();
        check_blocks(plan, diagnostics);
        check_reach();
        plan_rules(plan, diagnostics);
        check_measures(plan, scene, diagnostics);
        plan_custom_measures(plan, diagnostics);
        for (const scene::Finger& finger : scene.fingers)
            plan.finger_radius.push_back(reach_of(finger));
        plan_participants();
    }

  private:
    void name_quantities() {
        plan.quantities = Quantities({.fingers = names.all<scene::Finger>(),
                                      .bodies = names.all<scene::Body>(),
                                      .joints = names.all<scene::Joint>(),
                                      .regions = names.all<Region>(),
                                      .hands = hands()});
        // bodies that no trial places start at their positions in the scene
        for (size_t i = 0; i < scene.bodies.size(); ++i)
            plan.quantities.set(plan.quantities.start(i), scene.bodies[i].pose().p);
        plan.bodies = scene.bodies.size();
    }

    std::vector<Quantities::Names::Hand> hands() {
        std::vector<Quantities::Names::Hand> out;
        for (const Hand& hand : plan.task.hands) {
            out.push_back({hand.name, fingers_of(hand.fingers)});
            const auto among = [&](const std::vector<std::string>& list) {
                return std::find(list.begin(), list.end(), hand.name) != list.end();
            };
            if (among(names.all<Thing>()) || among(names.all<scene::Joint>()))
                diagnostics.error(
                    hand.place, "name",
                    fmt::format("'{}' is a finger, a body or a joint of the scene", hand.name),
                    "Give the hand another name.");
            if (hand.fingers.empty())
                diagnostics.error(hand.place, "fingers", "there are none", "Name at least one.");
        }
        return out;
    }

    /// Plans the hand of each participant; its fingers follow those of the previous participant.
    void plan_participants() {
        const RefList<Hand>& hands = plan.task.participants;
        if (hands.empty()) return;
        if (hands.size() != 2)
            return diagnostics.error(
                plan.task.place, "participants",
                fmt::format("has {}, but a task is for one participant or two",
                            counted(static_cast<int64_t>(hands.size()), "hand")),
                "Write e.g. participants: [A, B], or leave it out.");
        size_t next = 0;
        plan.first_fingers.clear();
        for (const int i : hands.indices) {
            plan.first_fingers.push_back(next);
            for (const int finger : plan.task.hands[static_cast<size_t>(i)].fingers.indices) {
                if (finger == static_cast<int>(next++)) continue;
                return wrong_hands();
            }
        }
        if (next != scene.fingers.size()) wrong_hands();
    }
    void wrong_hands() {
        diagnostics.error(plan.task.place, "participants",
                          "must include all fingers of the scene, hand by hand, in its order",
                          "List the fingers of 'hands' as the scene does, each in one hand.");
    }

    void check_condition(const Condition& condition) {
        bodies_.check(condition);
        for (const Region& region : condition.regions)
            look_up(names.all<Region>(), region.name, region.place, "name",
                    "not a region of the task", diagnostics);
        for (const PerturbationSpec& spec : condition.perturbations)
            look_up(names.all<PerturbationSpec>(), spec.name, spec.place, "name",
                    "not a perturbation of the task", diagnostics);
    }

    void plan_sounds() {
        const std::vector<SoundSpec>& sounds = plan.task.sounds;
        for (size_t i = 0; i < sounds.size() && i < TaskPlan::kMostSounds; ++i) {
            check(sounds[i], diagnostics);
            if (sounds[i].lasts == Lasts::state) plan.going_on |= 1u << i;
            if (sounds[i].lasts == Lasts::session) plan.throughout |= 1u << i;
        }
    }

    void check_reach() {
        if (!plan.task.reach) return;
        const ReachMeasure& reach = *plan.task.reach;
        check_fixed(reach.from.index, reach.place, "from");
        check_fixed(reach.to.index, reach.place, "to");
        if (reach.axis && reach.axis->norm() <= 0)
            diagnostics.error(reach.place, "axis", "has no direction",
                              "Write e.g. axis: [0, 0, 1].");
    }

    /// Checks a region used by a reach, because the measurement of reaches is frozen before the
    /// session.
    void check_fixed(int region, const Place& place, const char* key) {
        if (region < 0) return;
        for (const TaskPlan::Cell& cell : plan.cells) {
            for (const Formula& n : cell.regions[static_cast<size_t>(region)].position) {
                if (n.index < 0 || plan.formulas[static_cast<size_t>(n.index)].expression.frozen())
                    continue;
                diagnostics.error(place, key, "is a region that variables move",
                                  "Measure between regions that depend only on draws and factors.");
                return;
            }
        }
    }

    SeenPlanner seen_;
    BodyPlanner bodies_;
};

}  // namespace

std::string conditions_with(const std::string& given, unsigned any) {
    std::vector<std::string> names;
    for (const WhenRow& row : kWhenTable) {
        if ((row.has & any) != 0) names.emplace_back(*row.name == 0 ? "an expression" : row.name);
    }
    if (const std::string guess = nearest(given, names); !guess.empty() && guess != given)
        return fmt::format("Did you mean when: {}?", guess);
    return fmt::format("It belongs to when: {}.", fmt::join(names, ", "));
}

std::vector<std::string> TaskPlan::phases() const {
    std::vector<std::string> out{"between trials"};
    for (const State& state : task.states) out.push_back(state.name);
    return out;
}

std::vector<int> TaskPlan::used_in(const Trial& trial) const {
    const Cell& cell = this->cell(trial);
    std::vector<int> out = in_states;
    out.insert(out.end(), cell.formulas.begin(), cell.formulas.end());
    return out;
}

double TaskPlan::largest(const Formula& number) const {
    if (number.index < 0) return number.value;
    const CompiledFormula& compiled = formulas[static_cast<size_t>(number.index)];
    return compiled.expression.foreseen() ? compiled.largest : compiled.formula.field.max;
}

TaskPlan plan_task(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics) {
    TaskPlan out;
    out.task = task;
    cross_factors(out.task, diagnostics);
    complete_intervals(out.task, diagnostics);
    check_lists(out.task, diagnostics);
    const Names names(out.task, scene);
    resolve(out.task, names, diagnostics);
    Planner({out, names, scene, diagnostics}).plan_all();
    return out;
}

Table frozen_list(const TaskPlan& plan, const scene::Scene& scene) {
    Table table = trial_list(plan.task, plan.trials);
    if (plan.task.reach) add_reaches(table, plan, scene);
    add_movements(table, plan, scene);
    return table;
}

Table procedure_table(const TaskPlan& plan) {
    std::vector<rows::ProcedureRow> out;
    for (const ProcedureSpec& p : plan.task.procedures) {
        out.push_back({p.name, std::string(p.kind()),
                       fmt::format("{}", fmt::join(p.perturb, kBetweenNames)), p.logarithmic, p.yes,
                       p.no, p.fitted(), p.known_shape().value_or(kUnmeasured), p.guess,
                       p.guess_is_lapse, p.level, p.standard.value_or(kUnmeasured)});
    }
    return figure_table<rows::ProcedureRow>(out);
}

}  // namespace dihaptic::task
