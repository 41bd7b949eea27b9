#include "session/lift_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <set>
#include <tuple>

#include "model/grasp.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::session {
namespace {

/// An object to be lifted in the task's trials, with the weight and friction that it has in those
/// trials.
struct Lifting {
    std::string what;  // description
    double weight;     // [N]
    double friction;   // friction coefficient with the most slippery finger
};

/// Returns the bodies for whose grip or lift the task waits.
std::set<std::string> lifted_bodies(const task::Task& task) {
    std::set<std::string> out;
    for (const task::State& state : task.states) {
        for (const task::Exit& exit : state.exits) {
            if (exit.when == task::When::gripped || exit.when == task::When::lifted)
                out.insert(exit.body);
        }
    }
    return out;
}

std::vector<Lifting> liftings(const Plan& plan) {
    const std::set<std::string> lifted = lifted_bodies(plan.task->task);
    std::vector<Lifting> out;
    std::set<std::string> known;
    task::each_trial(*plan.task, [&](size_t t, const task::TrialNumbers& numbers) {
        const task::Trial& trial = plan.task->trials[t];
        const task::TaskPlan::Cell& cell = numbers.cell();
        for (const std::string& name : lifted) {
            const int index = plan.scene.find(name);
            const scene::Body& body = plan.scene.bodies[static_cast<size_t>(index)];
            double weight = scene::mass(body) * plan.scene.gravity.norm();
            double friction = std::numeric_limits<double>::infinity();
            for (const scene::Finger& finger : plan.scene.fingers) {
                friction =
                    std::min(friction, scene::pair_friction(plan.scene, body.name, body.friction,
                                                            finger.name, finger.friction));
            }
            for (const int p : trial.perturb) {
                const auto changed = cell.perturbations[static_cast<size_t>(p)].properties();
                if (changed && changed->body == index) {
                    weight *= changed->weight_scale;
                    friction *= changed->friction_scale;
                }
            }
            const std::string what =
                fmt::format("{} of {:.0f} g with friction {:.2g}", name,
                            weight / plan.scene.gravity.norm() * 1e3, friction);
            if (known.insert(what).second) out.push_back({what, weight, friction});
        }
    });
    std::sort(out.begin(), out.end(), [](const Lifting& a, const Lifting& b) {
        return std::tie(a.weight, a.friction) < std::tie(b.weight, b.friction);
    });
    return out;
}

/// Returns the bodies whose lifts are measured in some trial.
std::set<std::string> measured_bodies(const Plan& plan) {
    const task::Task& task = plan.task->task;
    std::set<std::string> out{
        plan.scene.bodies[static_cast<size_t>(plan.scene.object_index())].name};
    for (const auto* list : {&task.conditions, &task.rounds}) {
        for (const task::Condition& condition : *list) {
            if (!condition.object.empty()) out.insert(condition.object);
        }
    }
    return out;
}

/// Returns the movable bodies that are joined to this one.
std::set<std::string> joined_to(const std::string& body, const scene::Scene& scene) {
    std::set<std::string> out;
    for (const scene::Joint& joint : scene.joints) {
        const auto& ends = joint.between;
        if (std::find(ends.begin(), ends.end(), body) != ends.end())
            out.insert(ends.begin(), ends.end());
    }
    std::erase_if(out, [&](const std::string& other) {
        const int index = scene.find(other);
        return other == body || index < 0 ||
               !scene.bodies[static_cast<size_t>(index)].moves_at_all();
    });
    return out;
}

/// Warns of grips that the analysis of lifts would miss, because it counts only contact with the
/// trial's object.
void check_objects(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.task || plan.scene.object_index() < 0 || plan.scene.fingers.size() < 2) return;
    const std::set<std::string> measured = measured_bodies(plan);
    for (const std::string& name : lifted_bodies(plan.task->task)) {
        const Place& place = plan.scene.bodies[static_cast<size_t>(plan.scene.find(name))].place;
        if (measured.count(name) == 0) {
            diagnostics.warning(
                place, name,
                fmt::format("is gripped or lifted in the task, but only lifts of {} are measured, "
                            "so that those of '{}' will be marked 'no touch'",
                            fmt::join(measured, " and "), name),
                fmt::format("Add object: {} to the conditions in which it is lifted, or to the "
                            "scene.",
                            name));
        }
        const std::set<std::string> parts = joined_to(name, plan.scene);
        // an object that the file names was chosen among the parts
        if (measured.count(name) == 0 || parts.empty() || !plan.scene.object.empty()) continue;
        diagnostics.warning(
            place, name,
            fmt::format("is joined to {}, but only contact with '{}' itself counts as touch, grip "
                        "and load in the lifts",
                        fmt::join(parts, " and "), name),
            "Name the part that the fingers hold in the scene, with object:.");
    }
}

/// Warns about objects that two fingers cannot hold with these devices, however hard they pinch.
void check_liftings(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.task || plan.scene.fingers.size() != 2 || plan.scene.gravity.norm() == 0) return;
    double peak = std::numeric_limits<double>::infinity();
    double continuous = peak;
    for (const frame::DeviceInfo& info : plan.devices) {
        peak = std::min(peak, info.peak_force);
        continuous = std::min(continuous, info.continuous_force);
    }
    if (plan.settings.safety.max_force) peak = std::min(peak, *plan.settings.safety.max_force);
    std::string beyond;
    std::string for_long;
    for (const Lifting& lifting : liftings(plan)) {
        const double force = model::smallest_hold(lifting.weight, lifting.friction);
        std::string& list = force > peak ? beyond : for_long;
        if (force <= std::min(peak, continuous)) continue;
        list += fmt::format("{}{} ({:.1f} N)", list.empty() ? "" : ", ", lifting.what, force);
    }
    const auto warn = [&](double limit, const char* gives, const char* then,
                          const std::string& which) {
        if (which.empty()) return;
        diagnostics.warning(
            plan.task->task.place, "task",
            fmt::format("requires more of each finger than the {:.1f} N that {} {}, so that "
                        "the object slips {}: {}",
                        limit, plan.devices.front().model, gives, then, which),
            "Make it lighter or less slippery, or use a rig with stronger devices.");
    };
    warn(peak, "gives at most", "however hard it is pinched", beyond);
    warn(continuous, "can sustain", "after some seconds", for_long);
}

}  // namespace

void check_lifts(const Plan& plan, Diagnostics& diagnostics) {
    check_objects(plan, diagnostics);
    check_liftings(plan, diagnostics);
}

}  // namespace dihaptic::session
