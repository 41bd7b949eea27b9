#include "task/reach_plan.h"

#include <algorithm>
#include <utility>

#include "task/trial_numbers.h"

namespace dihaptic::task {
namespace {

constexpr double kMostPhases = 1e6;

/// The columns of a reach, each with its cell.
std::vector<std::pair<Table::Column, Table::Cell>> columns_of(const ReachPlan& reach) {
    std::vector<std::pair<Table::Column, Table::Cell>> out{
        {{kFirstReachColumn, "whose reach is measured"}, reach.finger},
        {{"reach_at_mm", "from its beginning"}, reach.distance * 1e3}};
    const auto add = [&](const std::string& what, const char* unit, const Vec3& v,
                         const char* description) {
        for (int k = 0; k < 3; ++k) {
            const std::string axis(1, "xyz"[k]);
            out.push_back({{what + axis + unit, k == 0 ? description : ""}, v[k]});
        }
    };
    add("reach_from_", "_mm", reach.from_W * 1e3, "");
    add("reach_to_", "_mm", reach.to_W * 1e3, "");
    add("reach_axis_", "", reach.axis_W, "that angles are about");
    out.push_back({{"reach_phase", "in which it is measured"}, static_cast<double>(reach.phase)});
    out.push_back({{"reach_measure", "angle or extent"}, std::string(enum_name(reach.measure))});
    return out;
}

}  // namespace

Vec3 usual_axis(const TaskPlan::Cell& cell) {
    for (const Perturbation& perturbation : cell.perturbations) {
        if (const auto axis = perturbation.axis()) return *axis;
    }
    return Vec3::UnitZ();
}

void add_reaches(Table& list, const TaskPlan& plan, const scene::Scene& scene) {
    for (const auto& [column, unused] : columns_of({})) list.columns.push_back(column);
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
        for (const auto& [unused, value] : columns_of(reach)) list.rows[i].push_back(value);
    }
}

std::vector<ReachPlan> read_reaches(const std::string& file) {
    const CsvFile list(file);
    std::vector<ReachPlan> out;
    if (!list.has(kFirstReachColumn)) return out;
    for (size_t i = 0; i < list.rows(); ++i) {
        const auto vector = [&](const std::string& what, const char* unit) {
            Vec3 v;
            for (int k = 0; k < 3; ++k) v[k] = list.number(i, what + "xyz"[k] + unit);
            return v;
        };
        ReachPlan& reach = out.emplace_back();
        reach.finger = list.text(i, kFirstReachColumn);
        reach.distance = list.number(i, "reach_at_mm") * 1e-3;
        reach.from_W = vector("reach_from_", "_mm") * 1e-3;
        reach.to_W = vector("reach_to_", "_mm") * 1e-3;
        reach.axis_W = vector("reach_axis_", "");
        const double phase = list.number(i, "reach_phase");
        if (phase >= 0 && phase < kMostPhases) reach.phase = static_cast<int>(phase);
        if (list.text(i, "reach_measure") == enum_name(Measure::extent))
            reach.measure = Measure::extent;
    }
    return out;
}

}  // namespace dihaptic::task
