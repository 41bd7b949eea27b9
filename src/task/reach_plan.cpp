#include "task/reach_plan.h"

#include <algorithm>
#include <utility>

#include "task/trial_numbers.h"

namespace dihaptic::task {
Vec3 usual_axis(const TaskPlan::Cell& cell) {
    for (const Perturbation& perturbation : cell.perturbations) {
        if (const auto axis = perturbation.axis()) return *axis;
    }
    return Vec3::UnitZ();
}

void add_reaches(Table& list, const TaskPlan& plan, const scene::Scene& scene) {
    add_columns<ReachPlan>(list);
    const ReachMeasure& measured = *plan.task.reach;
    const auto region = [&](const std::string& name) {
        const auto named = [&](const Region& r) { return r.name == name; };
        const auto found = std::find_if(plan.task.regions.begin(), plan.task.regions.end(), named);
        return static_cast<size_t>(found - plan.task.regions.begin());
    };
    const std::vector<std::string> phases = plan.phases();
    ReachPlan reach;
    reach.finger = measured.finger.empty() ? scene.fingers.front().name : measured.finger;
    reach.distance = measured.distance;
    reach.phase =
        static_cast<int>(std::find(phases.begin(), phases.end(), measured.during) - phases.begin());
    reach.measure = measured.measure;
    TrialNumbers numbers(plan);
    for (size_t i = 0; i < plan.trials.size(); ++i) {
        numbers.begin(static_cast<int>(i), 1, plan.start);
        const TaskPlan::Cell& cell = numbers.cell();
        reach.from_W = cell.p_W[region(measured.from)];
        reach.to_W = cell.p_W[region(measured.to)];
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
