#include "experiment/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/table.h"
#include "experiment/task_director.h"
#include "experiment/task_hand.h"
#include "model/grasp.h"

namespace dihaptic::experiment {
namespace {

namespace fs = std::filesystem;

std::string beside(const std::string& file, const std::string& named) {
    if (fs::path(named).is_absolute()) return named;
    return (fs::path(file).parent_path() / named).lexically_normal().string();
}

/// "coupling.stiffness_N_m=600" as the mapping that a file would have.
Node setting(const std::string& text) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos) {
        throw Error({"--set", 0}, text, "has no value", "Write --set coupling.stiffness_N_m=600.");
    }
    std::string path = text.substr(0, equals);
    Node value;
    try {
        value = parse_yaml(text.substr(equals + 1), "command line");
    } catch (const Error&) {
        throw Error({"--set", 0}, text, "its value cannot be read",
                    "Write --set coupling.stiffness_N_m=600.");
    }
    for (size_t dot = path.rfind('.');; dot = path.rfind('.')) {
        value.place = {"command line", 0};
        Node outer = Node::mapping();
        outer.place = value.place;
        outer.set(dot == std::string::npos ? path : path.substr(dot + 1), value);
        value = std::move(outer);
        if (dot == std::string::npos) return value;
        path.resize(dot);
    }
}

void overlay(Plan& plan, const Node& settings, Diagnostics& diagnostics) {
    if (settings.kind != Node::Kind::null)
        read_fields(plan.settings, settings, diagnostics, &plan.origins);
}

/// Where a setting was given, for messages.
Place place_of(const Plan& plan, const std::string& setting) {
    const auto origin = plan.origins.find(setting);
    return {origin == plan.origins.end() ? "" : origin->second, 0};
}

/// A share of what the devices render calmly, in SI units: of the device that renders least, since
/// all fingers have the same coupling. The setting is then as if it had been given so.
std::optional<double> of_maximum(Plan& plan, const devices::DeviceGroup& devices,
                                 const std::string& name, Quantity quantity,
                                 std::optional<double>& share,
                                 std::optional<double> devices::DeviceInfo::*maximum,
                                 Diagnostics& diagnostics) {
    if (!share) return std::nullopt;
    const std::string setting = "coupling." + name;
    const std::string origin = place_of(plan, setting + "_share").file;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < devices.size(); ++i) {
        const devices::DeviceInfo& info = devices.info(i);
        if (!(info.*maximum)) {
            diagnostics.error(
                {origin, 0}, setting + "_share",
                fmt::format("{} does not say what {} it renders at most", info.model, name),
                fmt::format("Give coupling: {}, or another rig.", si_key(name, quantity)));
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

void resolve_shares(Plan& plan, const devices::DeviceGroup& devices, Diagnostics& diagnostics) {
    haptics::CouplingSettings& coupling = plan.settings.coupling;
    if (const auto k =
            of_maximum(plan, devices, "stiffness", Quantity::stiffness, coupling.stiffness_share,
                       &devices::DeviceInfo::max_stiffness, diagnostics))
        coupling.stiffness = *k;
    if (const auto c =
            of_maximum(plan, devices, "damping", Quantity::damping, coupling.damping_share,
                       &devices::DeviceInfo::max_damping, diagnostics))
        coupling.damping = *c;
}

bool is_point(const Plan& plan, const scene::Finger& finger) {
    return plan.settings.proxy.of(finger) == haptics::ProxyKind::point;
}

bool any_finger(const Plan& plan, haptics::ProxyKind kind) {
    return std::any_of(
        plan.scene.fingers.begin(), plan.scene.fingers.end(),
        [&](const scene::Finger& finger) { return plan.settings.proxy.of(finger) == kind; });
}

/// Stiffness that the loop need not hold calmly. The limit is passivity's: below it no hand makes
/// the loop shake; above it, some do (bench grasp measures how far one gets).
void check_stiffness(const Plan& plan, const devices::DeviceGroup& devices,
                     Diagnostics& diagnostics) {
    const haptics::CouplingSettings& coupling = plan.settings.coupling;
    const double h = plan.settings.step();
    const Place place = place_of(plan, "coupling.stiffness");
    for (int i = 0; i < devices.size(); ++i) {
        const devices::DeviceInfo& info = devices.info(i);
        if (info.damping <= 0) continue;
        const double limit =
            model::passive_stiffness(info.damping, plan.settings.tick() + 2 * info.delay);
        if (coupling.stiffness <= limit) continue;
        diagnostics.warning(
            place, "coupling.stiffness",
            fmt::format("{:g} N/m is above {:.0f} N/m (2 b / T), up to which the hand's damping of "
                        "{:g} N*s/m surely keeps {} calm",
                        coupling.stiffness, limit, info.damping, info.model),
            "It may be calm above too, as in bench grasp, or shake: look at the forces, or lower "
            "it.");
        break;
    }
    for (int i = 0; i < devices.size(); ++i) {
        const devices::DeviceInfo& info = devices.info(i);
        if (info.peak_torque <= 0 || info.turn_damping <= 0) continue;
        const double limit =
            model::passive_stiffness(info.turn_damping, plan.settings.tick() + 2 * info.delay);
        if (coupling.turn_stiffness <= limit) continue;
        diagnostics.warning(
            place_of(plan, "coupling.turn_stiffness"), "coupling.turn_stiffness",
            fmt::format("{:g} N*m/rad is above {:.3g} N*m/rad (2 b / T), up to which the hand's "
                        "damping of {:g} N*m*s/rad surely keeps {} calm",
                        coupling.turn_stiffness, limit, info.turn_damping, info.model),
            "Lower it, or look at the torques.");
        break;
    }
    const double explicit_limit = coupling.body_mass / (h * h);
    if (coupling.kind == haptics::CouplingKind::dual_spring &&
        any_finger(plan, haptics::ProxyKind::rigid) && coupling.stiffness > explicit_limit) {
        diagnostics.warning(
            place, "coupling.stiffness",
            fmt::format(
                "{:g} N/m is more than an explicit spring can hold with a proxy of {:g} g: about "
                "{:.0f} N/m (m / h^2)",
                coupling.stiffness, coupling.body_mass * 1e3, explicit_limit),
            "Lower it, raise coupling: body_mass_g, or use coupling: kind: implicit.");
    }
}

/// A damper that takes more than the handle's momentum in a tick throws it back: with v the speed
/// at the tick, v' = (1 - c T / m) v grows when c > 2 m / T.
void check_damping(const Plan& plan, const devices::DeviceGroup& devices,
                   Diagnostics& diagnostics) {
    if (!plan.settings.coupling.damping) return;
    for (int i = 0; i < devices.size(); ++i) {
        const devices::DeviceInfo& info = devices.info(i);
        const double limit = 2 * info.mass / (plan.settings.tick() + 2 * info.delay);
        if (info.mass <= 0 || *plan.settings.coupling.damping <= limit) continue;
        diagnostics.warning(
            place_of(plan, "coupling.damping"), "coupling.damping",
            fmt::format("{:g} N*s/m is more than a handle of {:g} g can bear: about {:.0f} N*s/m "
                        "(2 m / T)",
                        *plan.settings.coupling.damping, info.mass * 1e3, limit),
            "Lower it, or leave it out: k h / 2 follows the stiffness.");
        break;
    }
}

/// Settings that a point has no use for.
void check_proxy(const Plan& plan, Diagnostics& diagnostics) {
    if (!any_finger(plan, haptics::ProxyKind::point)) return;
    if (plan.settings.coupling.kind != haptics::CouplingKind::implicit &&
        !any_finger(plan, haptics::ProxyKind::rigid)) {
        diagnostics.warning(
            place_of(plan, "coupling.kind"), "coupling.kind",
            fmt::format("{} ties handles to rigid proxies; these proxies are points",
                        enum_name(plan.settings.coupling.kind)),
            "Leave it out, or use proxy: kind: rigid.");
    }
    if (plan.settings.proxy.friction == haptics::PointFriction::together) return;
    for (const scene::Finger& finger : plan.scene.fingers) {
        if (finger.torsion_radius <= 0 || !is_point(plan, finger)) continue;
        diagnostics.warning(finger.place, "torsion_radius",
                            "where its friction is apart from the dynamics, a point carries no "
                            "moment about a contact's normal",
                            "Leave it out, or use proxy: friction: together.");
    }
}

/// A switch that nobody could hold.
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

/// A force limit that no device reaches is none: the devices' own is what holds.
void check_limits(const Plan& plan, const devices::DeviceGroup& devices, Diagnostics& diagnostics) {
    if (!plan.settings.safety.max_force) return;
    for (int i = 0; i < devices.size(); ++i) {
        const devices::DeviceInfo& info = devices.info(i);
        if (*plan.settings.safety.max_force <= info.peak_force) continue;
        diagnostics.warning(
            place_of(plan, "safety.max_force"), "safety.max_force",
            fmt::format("{:g} N is more than {} can give: {:g} N is its peak",
                        *plan.settings.safety.max_force, info.model, info.peak_force),
            "The device's peak holds: lower it, or leave it out.");
        break;
    }
}

/// Soft fingers that are hard to this solver.
void check_torsion(const Plan& plan, Diagnostics& diagnostics) {
    if (plan.settings.dynamics.solver != dynamics::Solver::sequential_impulse) return;
    const bool apart = plan.settings.proxy.friction == haptics::PointFriction::apart;
    std::string soft;
    const auto look = [&](const auto& item) {
        if (item.torsion_radius > 0) soft += (soft.empty() ? "" : ", ") + item.name;
    };
    for (const scene::Body& body : plan.scene.bodies) look(body);
    for (const scene::Finger& finger : plan.scene.fingers) {
        if (!(apart && is_point(plan, finger))) look(finger);
    }
    if (soft.empty()) return;
    diagnostics.warning(
        place_of(plan, "dynamics.solver"), "dynamics.solver",
        fmt::format("sequential_impulse takes no notice of torsion radii: contacts of {} carry no "
                    "moment about their normal",
                    soft),
        "Use newton, staggered_projections or stewart_trinkle, or leave out torsion_radius_mm.");
}

void check_grip(const Plan& plan, const devices::DeviceGroup& devices, Diagnostics& diagnostics) {
    const int object = plan.scene.object_index();
    if (object < 0 || plan.scene.fingers.size() < 2) return;
    const double weight =
        scene::mass(plan.scene.bodies[static_cast<size_t>(object)]) * plan.scene.gravity.norm();
    double force = 0;
    for (int i = 0; i < devices.size(); ++i) force += devices.info(i).peak_force;
    if (weight <= force) return;
    diagnostics.warning(
        plan.scene.bodies[static_cast<size_t>(object)].place,
        plan.scene.bodies[static_cast<size_t>(object)].name,
        fmt::format("weighs {:.1f} N, more than the devices' {:.1f} N together", weight, force),
        "Make it lighter: it cannot be felt as it is.");
}

/// A field on a handle that the loop cannot hold calmly: as a coupling's stiffness and damping.
void check_fields(const Plan& plan, const devices::DeviceGroup& devices, Diagnostics& diagnostics) {
    if (!plan.task) return;
    double stiffness = 0;
    double damping = 0;
    int stiffest = 0;
    int most_damped = 0;
    for (const TaskPlan::Cell& cell : plan.task->cells) {
        for (const Perturbation& perturbation : cell.perturbations) {
            const auto field = perturbation.on_handle();
            if (field && field->stiffness > stiffness) {
                stiffness = field->stiffness;
                stiffest = field->finger;
            }
            if (field && std::abs(field->damping) > damping) {
                damping = std::abs(field->damping);
                most_damped = field->finger;
            }
        }
    }
    const auto period = [&](const devices::DeviceInfo& info) {
        return plan.settings.tick() + 2 * info.delay;
    };
    const devices::DeviceInfo& stiff = devices.info(stiffest);
    if (const double limit = model::passive_stiffness(stiff.damping, period(stiff));
        stiff.damping > 0 && stiffness > limit) {
        diagnostics.warning(
            plan.task->task.place, "stiffness",
            fmt::format("a channel of {:g} N/m is above {:.0f} N/m (2 b / T), up to which the "
                        "hand's damping of {:g} N*s/m surely keeps {} calm",
                        stiffness, limit, stiff.damping, stiff.model),
            "Lower it, or look whether the handle shakes.");
    }
    const devices::DeviceInfo& damped = devices.info(most_damped);
    if (const double limit = 2 * damped.mass / period(damped); damped.mass > 0 && damping > limit) {
        diagnostics.warning(
            plan.task->task.place, "damping",
            fmt::format("a field of {:g} N*s/m is more than a handle of {:g} g can bear: about "
                        "{:.0f} N*s/m (2 m / T)",
                        damping, damped.mass * 1e3, limit),
            "Lower it.");
    }
}

/// The trials, and the hand that does them.
void plan_trials(Plan& plan, const Task& task, const Request& request, Diagnostics& diagnostics) {
    auto made = std::make_shared<TaskPlan>(plan_task(task, plan.scene, diagnostics));
    const int number = participant_number(request.participant);
    if (needs_number(task) && number < 0) {
        diagnostics.error(
            task.place, "participant",
            request.participant.empty()
                ? "the order of the trials depends on the participant's number"
                : fmt::format("'{}' ends in no number, and the order of the trials depends on it",
                              request.participant),
            "Add e.g. --participant S07.");
    }
    diagnostics.throw_if_errors();
    made->trials = make_trials(task, number, request.seed);
    plan.task = made;
}

void make_task_hand(Plan& plan) {
    plan.seeing = std::make_shared<TaskHand>(plan.task, plan.hand, scene::finger_names(plan.scene));
    plan.driver = plan.seeing;
}

void check_with_devices(Plan& plan, Diagnostics& diagnostics) {
    check_dead_man(plan, diagnostics);
    diagnostics.throw_if_errors();
    // made once to see what the devices can do; the session makes its own
    const auto devices = make_servo(plan);
    resolve_shares(plan, devices->devices(), diagnostics);
    check_stiffness(plan, devices->devices(), diagnostics);
    check_damping(plan, devices->devices(), diagnostics);
    check_limits(plan, devices->devices(), diagnostics);
    check_proxy(plan, diagnostics);
    check_torsion(plan, diagnostics);
    check_grip(plan, devices->devices(), diagnostics);
    check_fields(plan, devices->devices(), diagnostics);
    diagnostics.throw_if_errors();
    plan.warnings = diagnostics.problems();
}

/// What is wrong with a movement in any experiment. Its axes are the experiment's business: they
/// make no difference here.
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

}  // namespace

Plan make_plan(const Request& request) {
    Plan plan;
    plan.file = request.file;
    plan.seed = request.seed;
    Diagnostics diagnostics;

    Experiment experiment;
    const FileKind kind = kind_of(request.file);
    if (kind != FileKind::scene && kind != FileKind::experiment) {
        throw Error({request.file, 0}, "", "is neither a scene nor an experiment",
                    "A scene has 'bodies:', an experiment has 'scene:'.");
    }
    std::string scene_file = request.file;
    if (kind == FileKind::experiment) {
        experiment = read_experiment(request.file, diagnostics);
        diagnostics.throw_if_errors();
        scene_file = beside(request.file, experiment.scene);
    }
    plan.scene_folder = fs::path(scene_file).parent_path().string();
    plan.scene = scene::read_scene(scene_file, diagnostics);
    diagnostics.throw_if_errors();
    plan.title = experiment.title.empty() ? plan.scene.title : experiment.title;

    if (!request.rig.empty()) {
        plan.rig = rig::read_rig(request.rig, diagnostics);
    } else if (!experiment.rig.empty()) {
        plan.rig = rig::read_rig(beside(request.file, experiment.rig), diagnostics);
    } else {
        // a mouse can turn the hand, which is felt where orientation is measured
        plan.rig = rig::simulated_rig(scene::finger_names(plan.scene), request.mouse);
    }
    const auto real = [](const rig::Device& device) { return device.backend != "simulated"; };
    if (request.simulate && std::any_of(plan.rig.devices.begin(), plan.rig.devices.end(), real))
        plan.rig = rig::simulated_rig(scene::finger_names(plan.scene));
    overlay(plan, plan.scene.settings, diagnostics);
    overlay(plan, plan.rig.settings, diagnostics);
    overlay(plan, experiment.settings, diagnostics);
    for (const std::string& text : request.set) overlay(plan, setting(text), diagnostics);

    if (plan.scene.hand.kind != Node::Kind::null)
        read_fields(plan.hand, plan.scene.hand, diagnostics);
    if (experiment.hand) plan.hand = *experiment.hand;
    diagnostics.throw_if_errors();

    const std::string movement = !request.movement.empty() ? request.movement
                                 : experiment.movement && !experiment.movement->file.empty()
                                     ? beside(request.file, experiment.movement->file)
                                     : "";
    if (!request.movement.empty() && !experiment.movement) {
        throw Error({request.file, 0}, "movement", "this file does not say how to use a movement",
                    "Use an experiment with 'movement:', such as experiments/reach-to-grasp.yaml.");
    }
    if (experiment.task) {
        if (experiment.movement) {
            diagnostics.error(experiment.movement->place, "movement",
                              "a task's hand follows its states, not a recorded movement",
                              "Leave out movement, or task.");
        }
        plan_trials(plan, *experiment.task, request, diagnostics);
    }
    if (request.mouse) {
        plan.mouse =
            std::make_shared<hand::MouseDriver>(plan.hand, scene::finger_names(plan.scene));
        plan.driver = plan.mouse;
    } else if (plan.task) {
        make_task_hand(plan);
    } else if (!movement.empty()) {
        plan.driver = place_movement(*experiment.movement, movement, experiment.movement->place,
                                     plan.scene, plan.movement, diagnostics);
        diagnostics.throw_if_errors();
    } else {
        plan.driver =
            std::make_shared<hand::ScriptDriver>(plan.hand, scene::finger_names(plan.scene));
    }

    check_with_devices(plan, diagnostics);
    return plan;
}

Plan make_rest(const std::string& session, recording::SessionInfo& info) {
    const auto folder = recording::SessionFolder::open(session);
    info = folder.read_info();
    if (!fs::exists(folder.file("task.yaml"))) {
        throw Error({session, 0}, "", "has no trials that could go on",
                    "Run the experiment again; dihaptic recover makes the files of what there is.");
    }
    Diagnostics diagnostics;
    diagnostics.add(folder.changed(info.inputs, Severity::error));
    diagnostics.throw_if_errors();
    Plan plan;
    plan.file = info.experiment;
    plan.title = info.title;
    plan.seed = std::stoull(info.seed);
    plan.resumes = folder.path();
    plan.scene_folder = folder.path();
    plan.scene = scene::read_scene(folder.file("scene.yaml"), diagnostics);
    plan.rig = rig::read_rig(folder.file("rig.yaml"), diagnostics);
    overlay(plan, read_yaml(folder.file("settings.yaml")), diagnostics);
    if (plan.scene.hand.kind != Node::Kind::null)
        read_fields(plan.hand, plan.scene.hand, diagnostics);
    Task task;
    read_fields(task, read_yaml(folder.file("task.yaml")), diagnostics);
    diagnostics.throw_if_errors();
    auto made = std::make_shared<TaskPlan>(plan_task(task, plan.scene, diagnostics));
    diagnostics.throw_if_errors();
    made->trials = read_trial_list(task, folder.file("trial-list.csv"));
    plan.task = made;

    // trials.csv has a row for each attempt, in the order in which they were made
    const auto rows = read_csv(folder.file("trials.csv"));
    const auto column = std::find(rows.front().begin(), rows.front().end(), "outcome");
    const auto at = static_cast<size_t>(column - rows.front().begin());
    for (size_t i = 1; i < rows.size(); ++i) {
        const auto same = [&](const TaskPlan::Outcome& o) { return o.name == rows[i].at(at); };
        const auto found = std::find_if(made->outcomes.begin(), made->outcomes.end(), same);
        if (found != made->outcomes.end())
            plan.done.push_back(static_cast<int>(found - made->outcomes.begin()));
    }
    if (TaskDirector(*made, plan.seed, plan.settings.tick(), plan.done).share() >= 1) {
        throw Error({session, 0}, "", "is complete: every trial is done",
                    "Run the experiment again for another session.");
    }
    make_task_hand(plan);
    check_with_devices(plan, diagnostics);
    return plan;
}

void apply_setting(servo::Settings& settings, const std::string& text) {
    Diagnostics diagnostics;
    read_fields(settings, setting(text), diagnostics);
    if (settings.coupling.stiffness_share || settings.coupling.damping_share) {
        diagnostics.error({"--set", 0}, text, "is a share of what a device renders at most",
                          "Here is no device that says so: write coupling.stiffness_N_m or "
                          "coupling.damping_Ns_m.");
    }
    diagnostics.throw_if_errors();
}

std::unique_ptr<servo::Servo> make_servo(const Plan& plan) {
    const std::vector<std::string> fingers = scene::finger_names(plan.scene);
    devices::Context context;
    context.tick = plan.settings.tick();
    context.driver = plan.driver.get();
    context.impedance = plan.hand.impedance;
    context.tremor = plan.hand.tremor;
    context.seed = plan.seed;
    return std::make_unique<servo::Servo>(plan.scene, plan.settings,
                                          rig::make_devices(plan.rig, fingers, context),
                                          rig::poses(plan.rig, fingers));
}

std::string check_file(const std::string& file, Diagnostics& diagnostics) {
    try {
        switch (kind_of(file)) {
            case FileKind::rig:
                rig::read_rig(file, diagnostics);
                return "rig";
            case FileKind::scene:
            case FileKind::experiment: {
                Request request;
                request.file = file;
                request.participant = "1";
                const Plan plan = make_plan(request);
                diagnostics.add(plan.warnings);
                return kind_of(file) == FileKind::scene ? "scene" : "experiment";
            }
            case FileKind::movement:
                check_movement(file, diagnostics);
                return "movement";
            case FileKind::unknown:
                diagnostics.error({file, 0}, "", "is no file that Dihaptic knows",
                                  "A scene has 'bodies:', a rig 'devices:', an experiment "
                                  "'scene:'; a movement ends in .csv.");
                return "unknown";
        }
    } catch (const Error& e) {
        diagnostics.add(e.problems());
    }
    return "";
}

}  // namespace dihaptic::experiment
