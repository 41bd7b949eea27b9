#include "experiment/check.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiment/plan.h"
#include "experiment/safety_limits.h"
#include "experiment/simulated_limits.h"

namespace dihaptic::experiment {
namespace {

/// Reports what would be wrong with a movement in any experiment. Its axes, which the experiment
/// chooses, make no difference here.
void check_movement(const std::string& file, Diagnostics& diagnostics) {
    const std::vector<std::string> usual{"thumb", "index", "middle", "ring", "little"};
    const hand::Movement movement =
        hand::read_movement(file, hand::RecordingAxes::world, diagnostics);
    for (const std::string& finger : movement.fingers) {
        if (std::find(usual.begin(), usual.end(), finger) != usual.end()) continue;
        const std::string guess = nearest(finger, usual);
        diagnostics.warning({file, 1}, finger, "is no usual name of a finger",
                            guess.empty() ? "The scene must name its finger so too: thumb and "
                                            "index, if it names none."
                                          : fmt::format("Did you mean {}?", guess));
    }
    if (diagnostics.has_errors()) return;
    if (movement.fingers.size() < 2) {
        diagnostics.warning({file, 1}, "",
                            fmt::format("there is only one finger, {}", movement.fingers.front()),
                            "A recorded grasp needs two.");
    }
    const hand::Path path = hand::repair(movement);
    for (const hand::Fault& fault : path.faults) {
        diagnostics.warning({file, fault.line}, "", hand::describe(fault, path.fingers),
                            "It will be bridged.");
    }
    warn_of_bridges(path, file, diagnostics);
    if (path.p_WH.size() > 1 && !hand::find_grasp(path)) {
        diagnostics.warning({file, 0}, "", kNoGrasp,
                            "An experiment must say when they closed: movement: grasp_at_s.");
    }
}

/// Warns of states that never end if what they wait for does not come.
std::vector<Problem> endless_states(const TaskPlan& task) {
    std::vector<Problem> out;
    for (size_t i = 0; i < task.stages.size(); ++i) {
        const auto& ways = task.stages[i].ways;
        const bool ends = std::any_of(ways.begin(), ways.end(), [](const TaskPlan::Way& way) {
            return way.exit.when == When::time || way.exit.when == When::key ||
                   way.exit.when == When::trigger || way.exit.when == When::button;
        });
        if (ends) continue;
        const State& state = task.task.states[i];
        out.push_back({Severity::warning, state.place, state.name,
                       "waits for ever when what it waits for does not come; a simulated session "
                       "is ended after a minute of it",
                       "Add an exit by time, e.g. - { when: time, hold_s: 10, outcome: too late, "
                       "redo: yes }."});
    }
    return out;
}

}  // namespace

Checked check_file(const std::string& file, Diagnostics& diagnostics, const std::string& rig) {
    try {
        switch (kind_of(file)) {
            case FileKind::rig:
                rig::read_rig(file, diagnostics);
                return {"rig", {}};
            case FileKind::scene:
            case FileKind::experiment: {
                Request request;
                request.file = file;
                request.rig = rig;
                request.participant = "1";
                const Plan plan = make_plan(request);
                diagnostics.add(plan.warnings);
                if (plan.task) {
                    diagnostics.add(endless_states(*plan.task));
                    diagnostics.add(simulated_limits(*plan.task));
                }
                return {kind_of(file) == FileKind::scene ? "scene" : "experiment",
                        describe_safety(plan)};
            }
            case FileKind::movement:
                check_movement(file, diagnostics);
                return {"movement", {}};
            case FileKind::unknown:
                diagnostics.error({file, 0}, "", "is no file that Dihaptic knows",
                                  "A scene has 'bodies:', a rig 'devices:', an experiment "
                                  "'scene:'; a movement ends in .csv.");
                return {"unknown", {}};
        }
    } catch (const Error& e) {
        diagnostics.add(e.problems());
    }
    return {};
}

}  // namespace dihaptic::experiment
