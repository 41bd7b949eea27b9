#include "experiment/plan.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

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
    Node value = parse_yaml(text.substr(equals + 1), "command line");
    std::string path = text.substr(0, equals);
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

/// Stiffness that the loop cannot hold calmly.
void check_stiffness(const Plan& plan, const devices::DeviceGroup& devices,
                     Diagnostics& diagnostics) {
    const haptics::CouplingSettings& coupling = plan.settings.coupling;
    const double h = plan.settings.step();
    const auto origin = plan.origins.find("coupling.stiffness");
    const Place place{origin == plan.origins.end() ? "" : origin->second, 0};
    for (int i = 0; i < devices.size(); ++i) {
        const devices::DeviceInfo& info = devices.info(i);
        if (info.damping <= 0) continue;
        const double limit =
            model::passive_stiffness(info.damping, plan.settings.tick() + 2 * info.delay);
        if (coupling.stiffness <= limit) continue;
        diagnostics.warning(place, "coupling.stiffness",
                            fmt::format("{:g} N/m is more than the loop can hold calmly with {}: "
                                        "about {:.0f} N/m (2 b / T)",
                                        coupling.stiffness, info.model, limit),
                            "Lower it, or expect shaking.");
        break;
    }
    const double explicit_limit = coupling.body_mass / (h * h);
    if (coupling.kind == haptics::CouplingKind::dual_spring &&
        coupling.stiffness > explicit_limit) {
        diagnostics.warning(
            place, "coupling.stiffness",
            fmt::format(
                "{:g} N/m is more than an explicit spring can hold with a proxy of {:g} g: about "
                "{:.0f} N/m (m / h^2)",
                coupling.stiffness, coupling.body_mass * 1e3, explicit_limit),
            "Lower it, raise coupling: body_mass_g, or use coupling: kind: implicit.");
    }
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
    plan.scene = scene::read_scene(scene_file, diagnostics);
    diagnostics.throw_if_errors();
    plan.title = experiment.title.empty() ? plan.scene.title : experiment.title;

    if (!request.rig.empty()) {
        plan.rig = rig::read_rig(request.rig, diagnostics);
    } else if (!experiment.rig.empty()) {
        plan.rig = rig::read_rig(beside(request.file, experiment.rig), diagnostics);
    } else {
        plan.rig = rig::simulated_rig(scene::finger_names(plan.scene));
    }
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
    if (!movement.empty()) {
        plan.driver = place_movement(*experiment.movement, movement, {request.file, 0}, plan.scene,
                                     plan.movement, diagnostics);
        diagnostics.throw_if_errors();
    } else {
        plan.driver =
            std::make_shared<hand::ScriptDriver>(plan.hand, scene::finger_names(plan.scene));
    }

    // made once to see what the devices can do; the session makes its own
    const auto devices = make_servo(plan);
    check_stiffness(plan, devices->devices(), diagnostics);
    check_grip(plan, devices->devices(), diagnostics);
    diagnostics.throw_if_errors();
    plan.warnings = diagnostics.problems();
    return plan;
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
                const Plan plan = make_plan(request);
                diagnostics.add(plan.warnings);
                return kind_of(file) == FileKind::scene ? "scene" : "experiment";
            }
            case FileKind::movement: {
                // its axes are the experiment's business; what is wrong with it is the same in any
                const hand::Movement movement =
                    hand::read_movement(file, hand::RecordingAxes::world, diagnostics);
                if (diagnostics.has_errors()) return "movement";
                const hand::Path path = hand::repair(movement);
                for (const hand::Fault& fault : path.faults) {
                    diagnostics.warning({file, fault.line}, "", hand::describe(fault, path.fingers),
                                        "It will be bridged.");
                }
                return "movement";
            }
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
