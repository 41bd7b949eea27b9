#include "task/plan/cell_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace dihaptic::task {
namespace {

/// Returns the list with each item replaced by the item of the same name in `others`, if `others`
/// has such an item.
template <class T>
std::vector<T> replaced(std::vector<T> list, const std::vector<T>& others) {
    for (T& item : list) {
        for (const T& other : others) {
            if (other.name == item.name) item = other;
        }
    }
    return list;
}

template <class List>
void note_formulas(List& list, std::vector<int>& out) {
    for (auto& item : list) {
        each_formula(item, [&](const Formula& formula) {
            if (formula.index >= 0) out.push_back(formula.index);
        });
    }
}

class CellPlanner : Planning {
  public:
    CellPlanner(const Planning& given, const BodyPlanner& bodies, const SeenPlanner& seen)
        : Planning(given), bodies_(bodies), seen_(seen) {}

    TaskPlan::Cell cell(const Condition& round, const Condition& condition, Diagnostics& found) {
        const Task& task = plan.task;
        TaskPlan::Cell out;
        out.regions = replaced(replaced(task.regions, round.regions), condition.regions);
        for (const Region& region : out.regions) out.p_W.push_back(value(region.position));
        for (const PerturbationSpec& spec :
             replaced(replaced(task.perturbations, round.perturbations), condition.perturbations))
            add_perturbation(out, spec, found);
        out.start_poses = bodies_.start_poses({&round, &condition});
        note_formulas(out.regions, out.formulas);
        note_formulas(out.start_poses, out.formulas);
        note_formulas(out.perturbations, out.formulas);
        out.looks.resize(task.states.size());
        for (const Condition* of : {&round, &condition}) {
            SeenPlanner::check_looks(of->look, found);
            for (size_t i = 0; i < out.looks.size(); ++i)
                seen_.add_looks(of->look, static_cast<int>(i), out.looks[i]);
        }
        return out;
    }

  private:
    void add_perturbation(TaskPlan::Cell& cell, const PerturbationSpec& spec, Diagnostics& found) {
        const Perturbation& added = cell.perturbations.emplace_back(spec, names, scene, found);
        for (const Load& load : added.loads())
            plan.longest_delay = std::max(plan.longest_delay, load.longest_delay());
        uint64_t& during = cell.during.emplace_back(0);
        const std::vector<State>& states = plan.task.states;
        for (size_t i = 0; i < std::min(states.size(), TaskPlan::kMostStates); ++i) {
            if (spec.during.empty() && states[i].perturbed) during |= uint64_t{1} << i;
        }
        for (const int i : spec.during.indices) {
            if (i >= static_cast<int>(TaskPlan::kMostStates)) continue;
            during |= uint64_t{1} << i;
            const State& state = states[static_cast<size_t>(i)];
            if (!state.perturbed)
                found.error(spec.place, "during",
                            fmt::format("no perturbation acts in '{}', which has 'perturbed: no'",
                                        state.name),
                            "Leave out one or the other.");
        }
    }

    const BodyPlanner& bodies_;
    const SeenPlanner& seen_;
};

}  // namespace

void plan_cells(const Planning& given, const BodyPlanner& bodies, const SeenPlanner& seen) {
    TaskPlan& plan = given.plan;
    CellPlanner planner(given, bodies, seen);
    const Condition nothing;
    const auto or_one = [&](const std::vector<Condition>& list) {
        return list.empty() ? std::vector<Condition>{nothing} : list;
    };
    std::vector<Condition> rounds = plan.task.rounds;
    const auto beside = [](const Block& block) { return block.once != Once::no; };
    if (rounds.empty() || std::ranges::any_of(plan.task.blocks, beside)) rounds.push_back(nothing);
    // mistakes already reported, so that a mistake in every cell is reported only once
    std::set<std::string> said;
    for (const Condition& round : rounds) {
        for (const Condition& condition : or_one(plan.task.conditions)) {
            Diagnostics found;
            plan.cells.push_back(planner.cell(round, condition, found));
            for (const Problem& problem : found.problems()) {
                if (said.insert(problem.text()).second) given.diagnostics.add({problem});
            }
        }
    }
}

}  // namespace dihaptic::task
