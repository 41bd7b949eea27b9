#include "session/plan_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "analysis/bids.h"
#include "analysis/trials.h"
#include "base/figure.h"
#include "recording/nwb.h"
#include "rows/lift_row.h"
#include "session/lift_checks.h"
#include "session/load_checks.h"
#include "session/mass_checks.h"
#include "session/proxies.h"
#include "session/rehearsal.h"
#include "session/task_checks.h"
#include "session/texture_checks.h"
#include "task/plan/levels.h"

namespace dihaptic::session {
namespace {

/// Returns where a setting comes from, for use in messages.
Place place_of(const Plan& plan, const std::string& setting) {
    const auto origin = plan.origins.find(setting);
    return {origin == plan.origins.end() ? "" : origin->second, 0};
}

/// Whether a device has reported its capabilities, or the rig describes them completely.
bool is_known(const frame::DeviceInfo& info) {
    return std::isfinite(info.peak_force);
}

/// Converts a setting given as a share of the devices' calm maximum to SI units. The weakest device
/// determines the result, since all fingers have the same coupling. Afterwards, the setting is
/// treated as if it had been given in SI units.
std::optional<double> of_maximum(Plan& plan, const std::string& name, Quantity quantity,
                                 std::optional<double>& share,
                                 std::optional<double> frame::DeviceInfo::*maximum,
                                 Diagnostics& diagnostics) {
    if (!share) return std::nullopt;
    const std::string setting = "coupling." + name;
    const std::string origin = place_of(plan, setting + "_share").file;
    double least = std::numeric_limits<double>::infinity();
    for (const frame::DeviceInfo& info : plan.devices) {
        if (!(info.*maximum) && !is_known(info)) return std::nullopt;
        if (!(info.*maximum)) {
            diagnostics.error(
                {origin, 0}, setting + "_share",
                fmt::format("{} does not report the largest {} that it renders", info.model, name),
                fmt::format("Give {} under 'coupling', or use another rig.",
                            si_key(name, quantity)));
            return std::nullopt;
        }
        least = std::min(least, *(info.*maximum));
    }
    plan.origins.erase(setting + "_share");
    plan.origins[setting] = fmt::format("{} ({:g} of the device's {:g} {})", origin, *share, least,
                                        si_symbol(quantity));
    const double value = *share * least;
    share.reset();
    return value;
}

void resolve_shares(Plan& plan, Diagnostics& diagnostics) {
    frame::CouplingSettings& coupling = plan.settings.coupling;
    if (const auto k = of_maximum(plan, "stiffness", Quantity::stiffness, coupling.stiffness_share,
                                  &frame::DeviceInfo::max_stiffness, diagnostics))
        coupling.stiffness = *k;
    if (const auto c = of_maximum(plan, "damping", Quantity::damping, coupling.damping_share,
                                  &frame::DeviceInfo::max_damping, diagnostics))
        coupling.damping = *c;
}

/// Warns about a stiffness at which the loop might not be calm. The limit is the passivity limit:
/// below it, no hand can make the loop shake; above it, some hands can (`bench grasp` measures the
/// practical limit).
void check_stiffness(const Plan& plan, Diagnostics& diagnostics) {
    const frame::CouplingSettings& coupling = plan.settings.coupling;
    if (coupling.stiffness_share) return;  // a share of a maximum that is not known yet
    const double h = plan.settings.step();
    const Place place = place_of(plan, "coupling.stiffness");
    for (const frame::DeviceInfo& info : plan.devices) {
        if (info.damping <= 0) continue;
        const double limit =
            model::passive_stiffness(info.damping, plan.settings.tick() + 2 * info.delay);
        if (coupling.stiffness <= limit) continue;
        diagnostics.warning(
            place, "coupling.stiffness",
            fmt::format("{:g} N/m is above {:.0f} N/m (2 b / T), the highest stiffness at which "
                        "the hand's damping of {:g} N*s/m is certain to keep {} calm",
                        coupling.stiffness, limit, info.damping, info.model),
            "It may stay calm above this limit, as in bench grasp, or shake: check the forces, "
            "or lower it.");
        break;
    }
    for (const frame::DeviceInfo& info : plan.devices) {
        if (info.peak_torque <= 0 || info.turn_damping <= 0) continue;
        const double limit =
            model::passive_stiffness(info.turn_damping, plan.settings.tick() + 2 * info.delay);
        if (coupling.turn_stiffness <= limit) continue;
        diagnostics.warning(
            place_of(plan, "coupling.turn_stiffness"), "coupling.turn_stiffness",
            fmt::format("{:g} N*m/rad is above {:.3g} N*m/rad (2 b / T), the highest stiffness at "
                        "which the hand's damping of {:g} N*m*s/rad is certain to keep {} calm",
                        coupling.turn_stiffness, limit, info.turn_damping, info.model),
            "Lower it, or check the torques.");
        break;
    }
    const double explicit_limit = coupling.body_mass / (h * h);
    if (coupling.kind == frame::CouplingKind::dual_spring &&
        any_finger(plan, scene::ProxyKind::rigid) && coupling.stiffness > explicit_limit) {
        diagnostics.warning(
            place, "coupling.stiffness",
            fmt::format(
                "{:g} N/m is too stiff for an explicit spring with a proxy of {:g} g; the limit is "
                "about {:.0f} N/m (m / h^2)",
                coupling.stiffness, coupling.body_mass * 1e3, explicit_limit),
            "Lower it, raise coupling: body_mass_g, or use coupling: kind: implicit.");
    }
}

/// Warns about too much damping. A damper that absorbs more than the handle's momentum within one
/// tick throws the handle back: the speed v at one tick becomes v' = (1 - c T / m) v at the next,
/// which grows in magnitude when c > 2 m / T.
void check_damping(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.settings.coupling.damping) return;
    for (const frame::DeviceInfo& info : plan.devices) {
        const double limit = 2 * info.mass / (plan.settings.tick() + 2 * info.delay);
        if (info.mass <= 0 || *plan.settings.coupling.damping <= limit) continue;
        diagnostics.warning(
            place_of(plan, "coupling.damping"), "coupling.damping",
            fmt::format("{:g} N*s/m is more than a handle of {:g} g can withstand: about {:.0f} "
                        "N*s/m (2 m / T)",
                        *plan.settings.coupling.damping, info.mass * 1e3, limit),
            "Lower it, or leave it out: the default, k h / 2, follows the stiffness.");
        break;
    }
}

/// Warns about settings that do not apply to point proxies.
void check_proxy(const Plan& plan, Diagnostics& diagnostics) {
    if (!any_finger(plan, scene::ProxyKind::point)) return;
    if (plan.settings.coupling.kind != frame::CouplingKind::implicit &&
        !any_finger(plan, scene::ProxyKind::rigid)) {
        diagnostics.warning(
            place_of(plan, "coupling.kind"), "coupling.kind",
            fmt::format("{} connects handles to rigid proxies, but these proxies are points",
                        enum_name(plan.settings.coupling.kind)),
            "Leave it out, or use a proxy of kind 'rigid'.");
    }
    if (plan.settings.proxy.friction == frame::PointFriction::together) return;
    for (const scene::Finger& finger : plan.scene.fingers) {
        if (finger.torsion_radius <= 0 || proxy_of(plan, finger) != scene::ProxyKind::point)
            continue;
        diagnostics.warning(finger.place, "torsion_radius",
                            "if its friction is separate from the dynamics, a point carries no "
                            "moment about a contact's normal",
                            "Leave it out, or use 'friction: together' under 'proxy'.");
    }
}

/// Warns about a patch that a task requests but that the rig does not have.
void check_patch(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.task || plan.rig.patch) return;
    for (const task::State& state : plan.task->task.states) {
        if (!state.patch) continue;
        diagnostics.warning(state.place, "patch", "is not visible: the rig has no patch",
                            "Add e.g. patch: { corner: lower_right } to the rig file.");
        return;
    }
}

/// Warns about actions and items that are impossible or invisible in a headset.
void check_headset(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.task || !plan.rig.headset) return;
    for (const task::State& state : plan.task->task.states) {
        const auto by_mouse = [](const task::AskSpec& a) { return a.by == task::AnswerBy::mouse; };
        if (!std::ranges::any_of(state.questions(), by_mouse)) continue;
        diagnostics.warning(state.place, state.form ? "form" : "ask",
                            "is not shown in a headset, which has no mouse",
                            "Use by: key, or by: cursor.");
        return;
    }
}

/// Reports an error if the dead-man switch is assigned to a finger that is not in the scene, since
/// such a switch could not be held.
void check_dead_man(const Plan& plan, Diagnostics& diagnostics) {
    const std::string& finger = plan.settings.safety.dead_man_finger;
    const std::vector<std::string> fingers = scene::finger_names(plan.scene);
    if (finger.empty() || std::find(fingers.begin(), fingers.end(), finger) != fingers.end())
        return;
    diagnostics.error(place_of(plan, "safety.dead_man_finger"), "safety.dead_man_finger",
                      fmt::format("the scene has no finger '{}'", finger),
                      fmt::format("Name one of {}, whose device has the switch, or leave it out.",
                                  fmt::join(fingers, ", ")));
}

/// Warns about a force limit above the peak force of a device, which is then the effective limit.
void check_limits(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.settings.safety.max_force) return;
    for (const frame::DeviceInfo& info : plan.devices) {
        const double peak = info.peak_force / info.scale;  // peak force felt by the hand
        if (*plan.settings.safety.max_force <= peak) continue;
        diagnostics.warning(
            place_of(plan, "safety.max_force"), "safety.max_force",
            fmt::format("{:g} N is more than {} can give: {:g} N is its peak",
                        *plan.settings.safety.max_force, info.model, peak),
            "The device's peak is the effective limit: lower the setting, or leave it out.");
        break;
    }
}

void check_solver(const Plan& plan, Diagnostics& diagnostics) {
    const bool sweeps = plan.settings.dynamics.solver == contact::Solver::sequential_impulse;
    if (!sweeps || plan.scene.joints.empty()) return;
    diagnostics.warning(
        place_of(plan, "dynamics.solver"), "dynamics.solver",
        "sequential_impulse does not support joints: newton solves jointed bodies",
        "Choose newton for the whole scene, or keep the setting for bodies without joints.");
}

void check_grip(const Plan& plan, Diagnostics& diagnostics) {
    const int object = plan.scene.object_index();
    if (object < 0 || plan.scene.fingers.size() < 2) return;
    const double weight =
        scene::mass(plan.scene.bodies[static_cast<size_t>(object)]) * plan.scene.gravity.norm();
    double force = 0;
    for (const frame::DeviceInfo& info : plan.devices) force += info.peak_force;
    if (weight <= force) return;
    diagnostics.warning(
        plan.scene.bodies[static_cast<size_t>(object)].place,
        plan.scene.bodies[static_cast<size_t>(object)].name,
        fmt::format("weighs {:.1f} N, more than the devices' {:.1f} N together", weight, force),
        "Make it lighter: its weight cannot be rendered.");
}

/// Warns about trials that wait for a trigger when the rig has no trigger line.
void check_triggers(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.task) return;
    for (const outlets::OutletConfig& outlet : plan.rig.outlets) {
        const outlets::Kind* kind = outlets::find_kind(outlet.kind);
        if (kind != nullptr && kind->triggers) return;
    }
    for (const task::State& state : plan.task->task.states) {
        for (const task::Exit& exit : state.exits) {
            if (exit.when != task::When::trigger) continue;
            diagnostics.warning(
                exit.place, "when",
                "the rig has no line for receiving a trigger: on the real clock this waits forever",
                "Add to the rig e.g. outlets: [{ kind: serial, options: { port: "
                "/dev/ttyUSB0 } }].");
            return;
        }
    }
}

/// Warns about a wall placed so that it would push all the time.
void check_wall(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.rig.wall) return;
    const Eigen::AlignedBox3d box = plan.rig.wall->box();
    const char* const remedy = "'dihaptic workspace' proposes a wall and an origin that fit.";
    if (const int object = plan.scene.object_index(); object >= 0) {
        const scene::Body& body = plan.scene.bodies[static_cast<size_t>(object)];
        if (!box.contains(body.position)) {
            diagnostics.warning(
                plan.rig.wall->place, "wall",
                fmt::format("keeps hands away from the {}, which lies outside the wall", body.name),
                remedy);
        }
    }
    if (plan.task || plan.open_ended() || plan.driver == nullptr) return;
    constexpr int kMoments = 200;
    constexpr double kNear = 5e-3;  // [m]
    int out = 0;
    for (int i = 0; i < kMoments; ++i) {
        const double t = plan.driver->duration() * i / kMoments;
        for (size_t finger = 0; finger < plan.scene.fingers.size(); ++finger) {
            const Vec3 p = plan.driver->target(static_cast<int>(finger), t).p_WT;
            if (box.exteriorDistance(p) > kNear) {
                ++out;
                break;
            }
        }
    }
    if (out == 0) return;
    diagnostics.warning(
        plan.rig.wall->place, "wall",
        fmt::format("pushes the hand back in {:.0f} % of its movement", 100.0 * out / kMoments),
        remedy);
}

/// Whether the perturbation does nothing except keep movements in a plane.
bool is_plane(const task::PerturbationSpec& spec) {
    bool out = true;
    spec.each_effect([&](const auto& effect) {
        if constexpr (std::is_same_v<decltype(effect), const task::LoadSpec&>) {
            out = out && effect.kind == task::LoadKind::channel && effect.normal;
        } else {
            out = false;
        }
    });
    return out;
}

/// Whether the region's position depends on draws, factors or variables in any condition.
bool is_computed(const task::Task& task, const std::string& name) {
    const auto computed = [&](const std::vector<task::Region>& regions) {
        return std::any_of(regions.begin(), regions.end(), [&](const task::Region& region) {
            return region.name == name &&
                   std::any_of(region.position.begin(), region.position.end(),
                               [](const Formula& f) { return f.computed(); });
        });
    };
    const auto in = [&](const task::Condition& condition) { return computed(condition.regions); };
    return computed(task.regions) ||
           std::any_of(task.conditions.begin(), task.conditions.end(), in) ||
           std::any_of(task.rounds.begin(), task.rounds.end(), in);
}

/// Warns about trials whose measures will be misleading.
void check_measures(const task::TaskPlan& plan, Diagnostics& diagnostics) {
    for (const task::Block& block : plan.task.blocks) {
        if (block.kind != task::TrialKind::baseline) continue;
        const auto& all = plan.task.perturbations;
        const bool perturbed = std::any_of(all.begin(), all.end(), [&](const auto& spec) {
            return !is_plane(spec) && std::find(block.perturb.begin(), block.perturb.end(),
                                                spec.name) != block.perturb.end();
        });
        if (!perturbed) continue;
        diagnostics.warning(block.place, "kind",
                            "is baseline, but its trials are perturbed: means and fits treat them "
                            "as trials without a perturbation",
                            "Write kind: perturbed, or leave out 'perturb'.");
    }
    if (!plan.task.reach || plan.task.reach->measure != task::Measure::angle) return;
    const task::ReachMeasure& reach = *plan.task.reach;
    if (is_computed(plan.task, reach.from) || is_computed(plan.task, reach.to)) return;
    const auto& regions = plan.task.regions;
    const auto region = [&](const std::string& name) {
        const auto named = [&](const task::Region& r) { return r.name == name; };
        return static_cast<size_t>(std::find_if(regions.begin(), regions.end(), named) -
                                   regions.begin());
    };
    double shortest = std::numeric_limits<double>::infinity();
    for (const task::TaskPlan::Cell& cell : plan.cells) {
        const double way = (cell.p_W[region(reach.to)] - cell.p_W[region(reach.from)]).norm();
        shortest = std::min(shortest, way);
    }
    if (reach.distance <= shortest * (1 + 1e-9)) return;
    diagnostics.warning(reach.place, "distance",
                        fmt::format("is {:g} mm, but the nearest target is {:g} mm away: a hand "
                                    "that stops there is not measured",
                                    reach.distance * 1e3, shortest * 1e3),
                        "Measure before the target, e.g. at its edge.");
}

/// Returns the names of the columns that the task itself defines.
std::vector<std::string> columns_named_by(const task::Task& task) {
    std::vector<std::string> out;
    for (const Table::Column& column : task::own_columns(task)) out.push_back(column.name);
    for (const task::Variable& variable : task.variables) {
        out.push_back(variable.name);
        out.push_back(task::next_column(variable.name));
    }
    for (const task::CustomMeasure& measure : task.custom_measures) out.push_back(measure.name);
    for (const task::LevelName& level : task::levels_of(task)) out.push_back(level.name);
    for (const task::AskSpec& ask : task::questions_of(task)) out.push_back(ask.name);
    return out;
}

/// Names that a task must not give to its columns, each with the reason.
std::map<std::string, const char*> taken_names() {
    std::map<std::string, const char*> out;
    for (const char* name : analysis::kEventColumns)
        out[name] = "is the name of a column of events in BIDS";
    for (const char* name : recording::kReservedColumns)
        out[name] = "is a name that NWB gives to a part of each table";
    for (const char* name : kCollectedColumns)
        out[name] = "is the name of a column of 'dihaptic collect'";
    for (const char* name : kStudyColumns)
        out[name] = "is the name of a column of 'dihaptic collect' for a study";
    for (const Table::Column& column : list_figures(rows::LiftRow{}).columns)
        out["lift_" + column.name] = "is the name of a column of events in BIDS";
    for (const Table::Column& column : analysis::trial_columns())
        out[column.name] = "is the name of another column of trials.csv";
    for (const Table::Column& column : task::measure_columns())
        out[column.name] = "is the name of a column of measures";
    return out;
}

}  // namespace

void check_columns(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.task) return;
    std::map<std::string, const char*> known = taken_names();
    for (const std::string& name : columns_named_by(plan.task->task)) {
        const auto [at, is_new] =
            known.emplace(name, "is the name of another column of trials.csv");
        if (is_new) continue;
        diagnostics.error(
            plan.task->task.place, name, at->second,
            "Give the factor, draw, variable, level, answer or measure another name.");
    }
}

void check_devices(Plan& plan, Diagnostics& diagnostics) {
    resolve_shares(plan, diagnostics);
    check_stiffness(plan, diagnostics);
    diagnostics.throw_if_errors();
    if (!std::all_of(plan.devices.begin(), plan.devices.end(), is_known)) return;
    check_damping(plan, diagnostics);
    check_limits(plan, diagnostics);
    check_grip(plan, diagnostics);
    check_lifts(plan, diagnostics);
    check_loads(plan, diagnostics);
    diagnostics.throw_if_errors();
}

void check_plan(Plan& plan, Diagnostics& diagnostics) {
    check_dead_man(plan, diagnostics);
    check_solver(plan, diagnostics);
    check_masses(plan, diagnostics);
    diagnostics.throw_if_errors();
    check_devices(plan, diagnostics);
    check_proxy(plan, diagnostics);
    check_textures(plan, diagnostics);
    check_patch(plan, diagnostics);
    check_headset(plan, diagnostics);
    check_wall(plan, diagnostics);
    check_triggers(plan, diagnostics);
    if (plan.task) check_measures(*plan.task, diagnostics);
    check_task(plan, diagnostics);
}

}  // namespace dihaptic::session
