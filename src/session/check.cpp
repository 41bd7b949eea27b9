#include "session/check.h"

#include <fmt/format.h>

#include <algorithm>

#include "person/population.h"
#include "person/simulated_limits.h"
#include "session/plan.h"
#include "session/safety_limits.h"
#include "session/study_session.h"

namespace dihaptic::session {
namespace {

/// Reports faults that make a movement unusable in any experiment. The movement's axes, which the
/// experiment chooses, do not matter here.
void check_movement(const std::string& file, Diagnostics& diagnostics) {
    const std::vector<std::string> usual{"thumb", "index", "middle", "ring", "little"};
    const hand::Movement movement =
        hand::read_movement(file, hand::RecordingAxes::world, diagnostics);
    for (const std::string& finger : movement.fingers) {
        if (std::find(usual.begin(), usual.end(), finger) != usual.end()) continue;
        const std::string guess = nearest(finger, usual);
        diagnostics.warning({file, 1}, finger, "is not a usual name for a finger",
                            guess.empty() ? "The scene must use the same name; without names, its "
                                            "fingers are thumb and index."
                                          : fmt::format("Did you mean {}?", guess));
    }
    if (diagnostics.has_errors()) return;
    if (movement.fingers.size() < 2) {
        diagnostics.warning({file, 1}, "",
                            fmt::format("there is only one finger, {}", movement.fingers.front()),
                            "A recorded grasp requires two.");
    }
    const hand::Path path = hand::repair(movement);
    for (const hand::Fault& fault : path.faults) {
        diagnostics.warning({file, fault.line}, "", hand::describe(fault, path.fingers),
                            "It will be bridged.");
    }
    warn_of_bridges(path, file, diagnostics);
    if (path.p_WH.size() > 1 && !hand::find_grasp(path)) {
        diagnostics.warning(
            {file, 0}, "", kNoGrasp,
            "An experiment must give the time when the fingers closed: movement: grasp_at_s.");
    }
}

/// Warns about states that never end if the event for which they wait does not occur.
std::vector<Problem> endless_states(const task::TaskPlan& task) {
    std::vector<Problem> out;
    for (size_t i = 0; i < task.states.size(); ++i) {
        const auto& transitions = task.states[i].transitions;
        const bool ends = std::any_of(
            transitions.begin(), transitions.end(),
            [](const task::TaskPlan::Transition& transition) { return transition.comes(); });
        if (ends) continue;
        const task::State& state = task.task.states[i];
        out.push_back({Severity::warning, state.place, state.name,
                       "waits forever if the awaited event does not come; a simulated session is "
                       "ended after a minute of waiting",
                       "Add an exit by time, e.g. - { when: time, after_s: 10, outcome: too late, "
                       "redo: yes }."});
    }
    return out;
}

void warn_of_shares(const Plan& plan, Diagnostics& diagnostics) {
    const frame::CouplingSettings& coupling = plan.settings.coupling;
    if (!coupling.stiffness_share && !coupling.damping_share) return;
    diagnostics.warning(
        plan.rig.place, "coupling",
        "is a share of the devices' maximum, which they report only once they are open",
        "The share is resolved, and checked, when a session starts.");
}

}  // namespace

Checked check_file(const std::string& file, Diagnostics& diagnostics, const std::string& rig) {
    try {
        const task::FileKind kind = task::kind_of(file);
        switch (kind) {
            case task::FileKind::rig: {
                // read here only to check the settings: the plan of an experiment applies them
                // after those of its scene
                const rig::Rig checked = rig::read_rig(file, diagnostics);
                frame::Settings settings;
                read_given_fields(settings, checked.settings, diagnostics);
                return {"rig", {}};
            }
            case task::FileKind::scene:
            case task::FileKind::experiment: {
                Request request;
                request.file = file;
                request.rig = rig;
                request.participant = "1";
                const Plan plan = make_plan(request);
                diagnostics.add(plan.warnings);
                warn_of_shares(plan, diagnostics);
                if (plan.task) {
                    diagnostics.add(endless_states(*plan.task));
                    diagnostics.add(person::simulated_limits(*plan.task));
                }
                return {kind == task::FileKind::scene ? "scene" : "experiment",
                        describe_safety(plan)};
            }
            case task::FileKind::movement:
                check_movement(file, diagnostics);
                return {"movement", {}};
            case task::FileKind::population:
                person::read_population(file);
                return {"population", {}};
            case task::FileKind::study:
                checked_study(file, diagnostics);
                return {"study", {}};
            case task::FileKind::form:
                task::check(task::read_form(file, diagnostics), diagnostics);
                return {"form", {}};
            case task::FileKind::unknown:
                diagnostics.error(
                    {file, 0}, "", "is not a file that Dihaptic knows",
                    "A scene has 'bodies:', a rig 'devices:', an experiment "
                    "'scene:', a population 'traits:', a study 'sessions:', a form 'items:'; a "
                    "movement ends in .csv or .tsv.");
                return {"unknown", {}};
        }
    } catch (const Error& e) {
        diagnostics.add(e.problems());
    }
    return {};
}

}  // namespace dihaptic::session
