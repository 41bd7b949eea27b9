#include "task/plan/shown_targets.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace dihaptic::task {
namespace {

/// Changes a target as the looks say. Returns false if they hide it.
bool put_looks_on(frame::TargetFrame& target, const TaskPlan::Looks& looks) {
    for (const frame::TargetFrame& look : looks.targets) {
        if (look.region != target.region) continue;
        target.radius *= look.radius;
        if (look.colour >= 0) target.colour = look.colour;
    }
    return (looks.hidden_targets >> target.region & 1u) == 0;
}

bool is_same(const frame::TargetFrame& a, const frame::TargetFrame& b) {
    constexpr double kSame = 1e-6;  // [m]
    return (a.p_WT - b.p_WT).norm() < kSame && std::abs(a.radius - b.radius) < kSame;
}

}  // namespace

std::vector<frame::TargetFrame> shown_targets(const TaskPlan& plan) {
    std::vector<frame::TargetFrame> out;
    const auto add = [&](const frame::TargetFrame& target) {
        const bool placed = target.p_WT.allFinite() && std::isfinite(target.radius);
        const bool known = std::ranges::any_of(
            out, [&](const frame::TargetFrame& other) { return is_same(other, target); });
        if (placed && !known && out.size() < frame::TaskFrame::kMostTargets) out.push_back(target);
    };
    std::set<size_t> cells;  // a cell without trials is never shown
    for (const Trial& trial : plan.trials) cells.insert(plan.cell_index(trial));
    for (const size_t index : cells) {
        const TaskPlan::Cell& cell = plan.cells[index];
        for (size_t state = 0; state < plan.states.size(); ++state) {
            const TaskPlan::PlannedState& planned = plan.states[state];
            for (size_t i = 0; i < cell.p_W.size(); ++i) {
                if ((planned.shown >> i & 1u) == 0) continue;
                frame::TargetFrame target{static_cast<int32_t>(i), cell.p_W[i],
                                          cell.regions[i].radius.value};
                if (put_looks_on(target, cell.looks[state]) && put_looks_on(target, planned.looks))
                    add(target);
            }
        }
    }
    return out;
}

}  // namespace dihaptic::task
