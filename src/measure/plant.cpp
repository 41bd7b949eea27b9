#include "measure/plant.h"

#include <cmath>

#include "base/field_writer.h"
#include "base/number.h"
#include "measure/blocks.h"

namespace dihaptic::measure {
namespace {

scene::Finger pad(const std::string& name, double friction) {
    scene::Finger out;
    out.name = name;
    out.shape = scene::Shape::box({kPadThickness, 0.020, 0.020});
    out.mass = 0.001;
    out.friction = friction;
    return out;
}

/// Adds blocks in rows behind the held block, where they are out of the fingers' way.
void add_extra_blocks(scene::Scene& scene, int count, double friction) {
    for (int i = 0; i < count; ++i) {
        const double pitch = 0.05;
        const int column = i % 32;
        const int row = i / 32;
        scene::Body block =
            box("extra " + number_text(i), Vec3::Constant(kBlockSize),
                {(column - 15.5) * pitch, 0.15 + row * pitch, kBlockSize / 2}, friction);
        block.mass = 0.1;
        scene.bodies.push_back(block);
    }
}

/// Returns the devices of the setup, with the imperfections of the setup's row.
rig::Rig devices_of(const BenchSetup& setup, const std::vector<std::string>& fingers) {
    rig::Rig rig = rig::simulated_rig(fingers);
    for (size_t i = 0; i < fingers.size(); ++i) {
        if (i < setup.devices.size()) {
            rig.devices[i] = setup.devices[i];
            rig.devices[i].finger = fingers[i];
        }
        devices::simulated::Options options = simulated_options(rig.devices[i]);
        if (setup.row == Row::delay) ++options.delay_ticks;
        if (setup.row == Row::premium) {
            options.position_step = 0.03e-3;
            options.friction = 0.04;
        }
        rig.devices[i].options = write_fields(options);
    }
    return rig;
}

}  // namespace

devices::simulated::Options simulated_options(const rig::Device& device) {
    devices::simulated::Options options;
    Diagnostics diagnostics;
    read_given_fields(options, device.options, diagnostics);
    diagnostics.throw_if_errors();
    return options;
}

double press_force(const BenchSetup& setup) {
    // F = x k (a + b F) / (k + a + b F), where the stiffness of the hand is a + b F
    const double k = setup.settings.coupling.stiffness;
    const double a = setup.impedance.stiffness;
    const double b = setup.impedance.stiffness_per_force;
    const double half = (a + k - setup.squeeze * k * b) / 2;
    return setup.squeeze * k * a / (half + std::sqrt(half * half + b * setup.squeeze * k * a));
}

double reach(const BenchSetup& setup) {
    return setup.settings.proxy.kind == scene::ProxyKind::point ? 0 : kPadThickness / 2;
}

scene::Scene grasp_scene(const BenchSetup& setup) {
    scene::Scene scene;
    scene::Body table = box("table", {2.0, 4.0, 0.1}, {0, 1.5, -0.05}, setup.friction);
    table.fixed = true;
    scene::Body block =
        box("block", Vec3::Constant(kBlockSize), {0, 0, kBlockSize / 2}, setup.friction);
    block.mass = setup.mass;
    scene.bodies = {table, block};
    scene.object = "block";
    scene.fingers = {pad("thumb", setup.friction), pad("index", setup.friction)};
    if (setup.soft_radius > 0) {
        for (scene::Finger& finger : scene.fingers) {
            finger.shape = scene::Shape::sphere(kPadThickness / 2);
            finger.torsion_radius = setup.soft_radius;
        }
    }
    add_extra_blocks(scene, setup.extra_blocks, setup.friction);
    return scene;
}

hand::HandSpec grasp_hand(const BenchSetup& setup) {
    hand::HandSpec hand;
    hand.impedance = setup.impedance;
    const double contact = kBlockSize + 2 * reach(setup);
    hand.centre = {0, 0, kBlockSize / 2};
    hand.aperture = contact + 2 * kStartGap;
    const double closed = contact - 2 * setup.squeeze;
    hand.script = {{"close", 1, closed, Vec3::Zero(), false},
                   {"wait", 1, {}, Vec3::Zero(), false},
                   {"rise", setup.rise_time, {}, {0, 0, setup.lift}, false},
                   {"hold", setup.hold_time, {}, Vec3::Zero(), false},
                   {"open", 1, hand.aperture, Vec3::Zero(), false}};
    hand::FingerPlace thumb{"thumb", {-1, 0, 0}, Vec3::Zero()};
    hand::FingerPlace index{"index", {1, 0, 0}, Vec3::Zero()};
    switch (setup.fingering) {
        case Fingering::ideal:
            break;
        case Fingering::real:
            hand.tremor = {0.1e-3, 8, 9};
            [[fallthrough]];
        case Fingering::offset:
            thumb.offset = {0, 0.002, 0.002};
            index.offset = {0, -0.002, -0.002};
            break;
        case Fingering::off_centre:
            thumb.offset = index.offset = {0, 0, 0.005};
            break;
    }
    hand.fingers = {thumb, index};
    return hand;
}

scene::Scene wall_scene(const BenchSetup& setup) {
    scene::Scene scene;
    scene::Body wall = box("wall", {0.2, 0.5, 0.5}, {0.1, 0, 0}, setup.friction);
    wall.fixed = true;
    scene.bodies = {wall};
    scene.fingers = {pad("thumb", setup.friction)};
    return scene;
}

hand::HandSpec wall_hand(const BenchSetup& setup) {
    hand::HandSpec hand;
    hand.impedance = setup.impedance;
    hand.centre = {-reach(setup) - kStartGap, 0, 0};
    hand.script = {{"close", 1, {}, {kStartGap + setup.squeeze, 0, 0}, false},
                   {"hold", 5, {}, Vec3::Zero(), false}};
    return hand;
}

Bench::Bench(const scene::Scene& scene, const hand::HandSpec& hand, const BenchSetup& setup) {
    const std::vector<std::string> fingers = scene::finger_names(scene);
    driver_ = std::make_unique<hand::ScriptDriver>(hand, fingers);
    const rig::Rig rig = devices_of(setup, fingers);
    devices::Context context;
    context.tick = setup.settings.tick();
    context.driver = driver_.get();
    context.impedance = hand.impedance;
    context.tremor = hand.tremor;
    context.seed = 1;
    std::unique_ptr<devices::DeviceGroup> devices;
    if (setup.make_devices) {
        std::vector<devices::DeviceConfig> simulated;
        for (const rig::Device& device : rig.devices)
            simulated.push_back({device.finger, device.X_WD(), device.options});
        devices = setup.make_devices(simulated, context);
    } else {
        devices = rig::make_devices(rig, fingers, context);
    }
    servo_ = std::make_unique<servo::Servo>(scene, setup.settings, std::move(devices),
                                            rig::poses(rig, fingers));
    servo_->activate();
}

void Bench::run(const frame::FrameSink& sink, const frame::Director& extra,
                servo::TickTimes* times) {
    const auto& phases = driver_->phases();
    int32_t phase = 0;
    double now = 0;
    const double tick = servo_->settings().tick();
    const frame::Director director = [&](const frame::Frame& last,
                                         std::span<const frame::Handle> handles,
                                         frame::Commands& commands) {
        now = static_cast<double>(last.sequence + 1) * tick;
        while (phase + 1 < static_cast<int32_t>(phases.size()) &&
               now >= phases[static_cast<size_t>(phase)].end - tick / 2)
            ++phase;
        commands.phase = phase;
        if (extra) extra(last, handles, commands);
    };
    const std::atomic<bool> stop{false};
    run_virtual(*servo_, director, sink, from_seconds(driver_->duration()), stop, times);
}

}  // namespace dihaptic::measure
