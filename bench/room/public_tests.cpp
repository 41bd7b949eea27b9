#include "bench/public_tests.h"

#include <array>
#include <cmath>
#include <numbers>

#include "measure/blocks.h"
#include "model/gravity.h"

namespace dihaptic::bench {
namespace {

constexpr double kDropped = 0.02;  // slip of a body that its pads have lost [m]
constexpr double kSinks = 1e-3;    // sinking in 5 s of a body that is not held [m]
constexpr double kTests = 6;       // number of tests, for the progress
/// Coefficients of friction, relative to the smallest that can hold.
constexpr std::array kFactors{0.90, 0.98, 0.999, 1.0, 1.001, 1.02, 1.10};

int steps_in(double time) {
    return static_cast<int>(std::lround(time / kStep));
}

/// An object in the air between two pads of 75 g, which are pressed against it along x and move
/// along `moves` without turning. Bodies: the object, then the pads.
Trial pinched(scene::Body object, double width, double grip, double friction, scene::Axes moves) {
    Trial trial;
    object.friction = friction;
    trial.scene.bodies = {std::move(object)};
    for (const double side : {-1.0, 1.0}) {
        const double x = side * (width + 0.01) / 2;
        scene::Body pad =
            measure::box(side < 0 ? "left" : "right", {0.01, 0.02, 0.02}, {x, 0, 0}, friction);
        pad.mass = 0.075;
        pad.moves = moves;
        pad.turns = scene::Axes::none;
        trial.pushes.push_back({trial.scene.bodies.size(), {-side * grip, 0, 0}});
        trial.scene.bodies.push_back(pad);
    }
    return trial;
}

scene::Body block_of(double size, double mass) {
    scene::Body block = measure::box("block", Vec3::Constant(size), Vec3::Zero(), 0);
    block.mass = mass;
    return block;
}

/// Mean speed of the first body along `way` from 1 s to 6 s [um/s], when soft contacts bear their
/// load; none if it moved farther than a held body.
std::optional<double> creep(const Trial& trial, const Simulator& simulator, const Vec3& way) {
    const int settled = steps_in(1), all = steps_in(6);
    double at_first = 0, at_last = 0;
    int step = 0;
    bool kept = true;
    simulator.run(trial, all, [&](std::span<const Pose> X_WB) {
        const double moved = (X_WB[0].p - trial.scene.bodies[0].position).dot(way);
        if (++step == settled) at_first = moved;
        at_last = moved;
        kept = std::abs(moved) < kDropped;  // false for NaN too
        return kept;
    });
    if (!kept) return std::nullopt;
    return (at_last - at_first) / ((all - settled) * kStep) * 1e6;
}

/// A horizontal capsule of 45 g and 4 mm radius.
std::optional<double> capsule_creep(const Simulator& simulator, double grip) {
    scene::Body capsule;
    capsule.name = "capsule";
    capsule.shape.kind = scene::ShapeKind::capsule;
    capsule.shape.radius = 0.004;
    capsule.shape.length = 0.04;
    capsule.rotation = {std::numbers::pi / 2, 0, 0};
    capsule.mass = 0.045;
    return creep(pinched(capsule, 0.008, grip, 0.7, scene::Axes::x), simulator, -Vec3::UnitZ());
}

/// Whether a block of 100 g between pads of 5 N each stays for 5 s after its weight begins to act,
/// 0.2 s after the grip. `factor`: coefficient of friction relative to the critical one, at
/// which both pads can just bear the weight.
bool holds(const Simulator& simulator, double factor) {
    const double mass = 0.1, grip = 5;
    const double friction = factor * mass * model::kGravity / (2 * grip);
    Trial trial = pinched(block_of(0.04, mass), 0.04, grip, friction, scene::Axes::x);
    trial.scene.gravity = Vec3::Zero();
    const int gripped = steps_in(0.2);
    trial.pushes.push_back({0, {0, 0, -mass * model::kGravity}, gripped});
    Vec3 start = Vec3::Zero();
    int step = 0;
    bool held = true;
    simulator.run(trial, gripped + steps_in(5), [&](std::span<const Pose> X_WB) {
        if (step++ < gripped) start = X_WB[0].p;
        held = (X_WB[0].p - start).norm() < kSinks;
        return held;
    });
    return held;
}

/// A block that lies on a table, pushed by half of what friction can bear.
std::optional<double> pushed_creep(const Simulator& simulator) {
    const double friction = 0.5, mass = 0.1;
    Trial trial;
    trial.scene.bodies = {block_of(0.04, mass), measure::table(1, friction)};
    trial.scene.bodies[0].friction = friction;
    trial.scene.bodies[0].position = {0, 0, 0.02};
    trial.pushes = {{0, {friction * mass * model::kGravity / 2, 0, 0}}};
    return creep(trial, simulator, Vec3::UnitX());
}

/// Largest slip of a pad on a block of 500 g that is lifted from a table by 10 cm in a second, one
/// pad pulling half as much again as the other [mm]; none if the block was lost.
std::optional<double> lift_slip(const Simulator& simulator) {
    const double mass = 0.5, size = 0.05, friction = 0.8, rise = 0.2;
    Trial trial = pinched(block_of(size, mass), size, 20, friction, scene::Axes::xz);
    const double lift = (mass + 2 * 0.075) * (model::kGravity + rise);
    trial.pushes[0].force_W.z() = 0.6 * lift;
    trial.pushes[1].force_W.z() = 0.4 * lift;
    scene::Body table = measure::table(1, friction);
    table.position.z() -= size / 2;
    trial.scene.bodies.push_back(table);
    double most = 0;
    simulator.run(trial, steps_in(1), [&](std::span<const Pose> X_WB) {
        for (size_t pad = 1; pad <= 2; ++pad) {
            const Vec3 slip = X_WB[0].inverse() * X_WB[pad].p - trial.scene.bodies[pad].position;
            most = std::max(most, std::isfinite(slip.norm()) ? slip.norm() : kDropped);
        }
        return most < kDropped;
    });
    if (most >= kDropped) return std::nullopt;
    return most * 1e3;
}

}  // namespace

double measure_grip(const frame::DynamicsSettings& settings) {
    measure::BenchSetup setup;
    setup.settings.dynamics = settings;
    setup.settings.coupling.stiffness = 1000;
    return measure::measure_hold(setup).grip_ratio * measure::press_force(setup);
}

PublicFigures bench_peer_public(const Simulator& simulator, const measure::Progress& progress) {
    PublicFigures out;
    out.solver = simulator.name;
    double done = 0;
    const auto say = [&](const std::string& what) {
        if (progress) progress(what, done++ / kTests);
    };
    say("pinched capsule, 12 N");
    out.capsule_12_um_s = capsule_creep(simulator, 12);
    say("pinched capsule, 60 N");
    out.capsule_60_um_s = capsule_creep(simulator, 60);
    say("critical friction");
    for (const double factor : kFactors) {
        if (!holds(simulator, factor)) {
            out.slips_to = factor;
        } else if (!out.holds_from) {
            out.holds_from = factor;
        }
    }
    say("pushed block");
    out.pushed_um_s = pushed_creep(simulator);
    say("pinch and lift");
    out.lift_slip_mm = lift_slip(simulator);
    return out;
}

PublicFigures bench_public(const frame::DynamicsSettings& settings,
                           const measure::Progress& progress) {
    PublicFigures out = bench_peer_public(world_simulator(settings), progress);
    if (progress) progress("held block", 5 / kTests);
    out.grip_n = measure_grip(settings);
    return out;
}

}  // namespace dihaptic::bench
