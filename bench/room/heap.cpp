#include "bench/heap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/diagnostics.h"
#include "base/random.h"
#include "bench/bench_log.h"
#include "bench/shaking.h"
#include "measure/blocks.h"
#include "model/gravity.h"

namespace dihaptic::bench {
namespace {

constexpr double kHeapFriction = 0.6;
constexpr double kHeapAway = 2;      // from the held block [m]
constexpr double kSettleTime = 2.5;  // [s]
constexpr double kStirred = 0.5;     // largest force along an axis, relative to the weight

/// A bowl of four slopes steeper than the friction angle.
void add_bowl(scene::Scene& scene) {
    for (int side = 0; side < 4; ++side) {
        scene::Body body =
            measure::box(fmt::format("side {}", side), {1, 1, 0.1}, Vec3::Zero(), kHeapFriction);
        body.fixed = true;
        body.rotation = {0, 40 * std::numbers::pi / 180, side * std::numbers::pi / 2};
        body.position = Vec3(kHeapAway, 0, 0) + rotation_xyz(body.rotation) * Vec3(-0.5, 0, -0.05);
        scene.bodies.push_back(body);
    }
}

/// Boxes and balls of 2 to 5 cm and 20 to 200 g, in the air above the bowl.
std::vector<scene::Body> loose_bodies(int count) {
    Random random(1, "heap");
    std::vector<scene::Body> out;
    const int columns = std::max(1, static_cast<int>(std::cbrt(count)));
    for (int i = 0; i < count; ++i) {
        const auto length = [&] { return random.uniform(0.02, 0.05); };
        const double middle = (columns - 1) / 2.0;
        const Vec3 cell(i % columns - middle, i / columns % columns - middle,
                        i / (columns * columns) + 0.7 * columns);
        scene::Body body = measure::box(fmt::format("loose {}", i), {length(), length(), length()},
                                        Vec3(kHeapAway, 0, 0.04) + 0.09 * cell, kHeapFriction);
        if (i % 2 == 1) body.shape = scene::Shape::sphere(length() / 2);
        body.mass = 0.02 * std::pow(10, random.uniform(0, 1));
        body.position.head<2>() +=
            Eigen::Vector2d(random.uniform(-0.005, 0.005), random.uniform(-0.005, 0.005));
        body.rotation = {random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)};
        out.push_back(body);
    }
    return out;
}

/// Moves the loose bodies to their rest positions.
void let_fall(scene::Scene& scene) {
    frame::DynamicsSettings settings;
    settings.solver = contact::Solver::sequential_impulse;
    settings.iterations = 30;
    dynamics::World world(scene, settings);
    world.activate();
    const double step = 1e-3;
    for (double time = 0; time < kSettleTime; time += step) world.step(step);
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        scene::Body& body = scene.bodies[i];
        if (!body.moves_at_all()) continue;
        const Pose& X_WB = world.states()[i].X_WB;
        body.position = X_WB.p;
        body.rotation = angles_xyz(X_WB.R);
    }
}

void finish(recording::Recorder& recorder) {
    recorder.finish();
    if (recorder.dropped() == 0) return;
    throw Error(fmt::format("the log lost {} ticks, because its thread had too little processor "
                            "time",
                            recorder.dropped()),
                "close other programs");
}

}  // namespace

HeapFigures measure_heap(const measure::BenchSetup& base, int loose) {
    measure::BenchSetup setup = base;
    setup.settings.dynamics.sleeping = false;
    scene::Scene heap;
    add_bowl(heap);
    for (const scene::Body& body : loose_bodies(loose)) heap.bodies.push_back(body);
    let_fall(heap);
    scene::Scene scene = measure::grasp_scene(setup);
    const size_t first = scene.bodies.size();
    scene.bodies.insert(scene.bodies.end(), heap.bodies.begin(), heap.bodies.end());

    Random random(1, "stirring");
    std::vector<std::pair<dynamics::BodyIndex, Shaking>> stirring;
    for (size_t i = first; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].moves_at_all()) continue;
        const double weight = scene::mass(scene.bodies[i]) * model::kGravity;
        stirring.push_back({{static_cast<int>(i)}, {random, kStirred * weight, 0}});
    }
    measure::Bench bench(scene, measure::grasp_hand(setup), setup);
    dynamics::World& world = bench.servo().world();
    const BenchLog log(scene, setup.settings);
    recording::Recorder recorder = log.record(recording::Writing::in_thread);
    const auto hold = bench.driver().phases()[measure::kHold];
    analysis::GraspTrace trace(1, setup.settings.tick());
    servo::TickTimes all;
    servo::TickTimes held;
    const auto ticks = static_cast<size_t>(bench.driver().duration() / setup.settings.tick()) + 2;
    all.reserve(ticks);
    held.reserve(ticks);
    HeapFigures out;
    out.loose = loose;
    bench.run(
        [&](const frame::Frame& frame) {
            recorder.record(frame);
            trace.add(frame);
            if (frame.phase != measure::kHold) return;
            out.held_residual = std::max(out.held_residual, frame.solver_held_residual);
            out.ended += world.solve_stats().ended ? 1 : 0;
            out.unbalanced += (frame.status & kUnbalanced) != 0 ? 1 : 0;
            for (const contact::Contact& contact : world.contacts())
                out.overlap_mm = std::max(out.overlap_mm, -1e3 * contact.gap);
        },
        [&](const frame::Frame& last, std::span<const frame::Handle>, frame::Commands&) {
            const double time = static_cast<double>(last.sequence + 1) * setup.settings.tick();
            if (time < hold.start || time >= hold.end) return;
            for (const auto& [body, shaking] : stirring)
                world.apply(body, shaking.force(time), Vec3::Zero());
        },
        &all);
    const size_t from = static_cast<size_t>(hold.start / setup.settings.tick());
    for (size_t i = from; i < all.count() && i * setup.settings.tick() < hold.end; ++i)
        held.add(all.us()[i] * 1e-6);
    out.tick_median_us = held.quantile(0.5);
    out.tick_p99_us = held.quantile(0.99);
    out.tick_max_us = held.quantile(1);
    finish(recorder);
    out.hf_force_n = trace.force_above_5_hz(trace.of_phase(measure::kHold));
    return out;
}

std::vector<HeapFigures> bench_heap(const measure::BenchSetup& base, const std::vector<int>& loose,
                                    const measure::Progress& progress) {
    std::vector<HeapFigures> out;
    for (const int count : loose) {
        if (progress)
            progress(fmt::format("{} loose", count),
                     static_cast<double>(out.size()) / static_cast<double>(loose.size()));
        measure::BenchSetup setup = base;
        setup.settings.coupling.stiffness = 1000;
        out.push_back(measure_heap(setup, count));
    }
    return out;
}

}  // namespace dihaptic::bench
