#include "task/plan/reach_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "task/run/trial_numbers.h"

namespace dihaptic::task {
Vec3 usual_axis(const TaskPlan::Cell& cell) {
    for (const Perturbation& perturbation : cell.perturbations) {
        if (const auto axis = perturbation.axis()) return *axis;
    }
    return Vec3::UnitZ();
}

std::vector<int> ReachPlan::phase_numbers() const {
    std::vector<int> out;
    std::istringstream in(phases);
    for (int phase = 0; in >> phase;) out.push_back(phase);
    return out;
}

void add_reaches(Table& list, const TaskPlan& plan, const scene::Scene& scene) {
    add_columns<ReachPlan>(list);
    const ReachMeasure& measured = *plan.task.reach;
    ReachPlan reach;
    reach.finger = measured.finger.empty() ? scene.fingers.front().name : measured.finger;
    reach.distance = measured.distance;
    for (const int state : measured.during.indices)
        reach.phases += fmt::format("{}{}", reach.phases.empty() ? "" : " ", state + 1);
    reach.measure = measured.measure;
    TrialNumbers numbers(plan);
    for (size_t i = 0; i < plan.trials.size(); ++i) {
        numbers.begin(static_cast<int>(i), 1, plan.start);
        const TaskPlan::Cell& cell = numbers.cell();
        reach.from_W = cell.p_W[static_cast<size_t>(measured.from.index)];
        reach.to_W = cell.p_W[static_cast<size_t>(measured.to.index)];
        reach.axis_W = measured.axis ? measured.axis->normalized() : usual_axis(cell);
        add_cells(list.rows[i], reach);
    }
}

std::vector<ReachPlan> read_reaches(const std::string& file) {
    const rows::RowFile<ReachPlan> list(file);
    if (!list.column(kFirstReachColumn)) return {};
    return {list.begin(), list.end()};
}

}  // namespace dihaptic::task
