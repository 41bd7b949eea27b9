#include "bench/task.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "base/field_reader.h"
#include "bench/bench_log.h"
#include "bench/duration.h"
#include "task/expression/expression.h"
#include "task/plan/trials.h"
#include "task/run/task_director.h"

namespace dihaptic::bench {
namespace {

constexpr int kStates = 20;

/// Loads of every kind, too weak to change the grasp.
constexpr const char* kLoads = R"(
        - { kind: constant, on: index, force_N: [0, 0, 0.001] }
        - { kind: viscous, on: index, damping_Ns_m: 0.001 }
        - { kind: curl, on: index, damping_Ns_m: 0.001, axis: [0, 0, 1] }
        - { kind: general, on: index, about: start, B_Ns_m: [[0, -0.001, 0], [0.001, 0, 0], [0, 0, 0]] }
        - { kind: spring, on: index, about: start, stiffness_N_m: 0.01 }
        - { kind: spring, on: thumb, from: start, to: goal, stiffness_N_m: -0.01, safe_within_mm: 50 }
        - { kind: channel, on: thumb, about: start, normal: [0, 1, 0], stiffness_N_m: 0.01 }
        - { kind: viscous, on: thumb, damping_Ns_m: 0.001, delay_ms: 20 }
        - { kind: viscous, on: block, damping_Ns_m: 0.001 }
        - { kind: constant, on: block, force_N: [0, 0, 0.001] }
)";

/// One trial whose states share the time, each with a condition that never holds.
task::Task task_of(double time) {
    std::string yaml = R"(regions:
  - { name: start, position_mm: [0, 0, 20] }
  - { name: goal, position_mm: [0, 0, 120] }
perturbations:
  - name: pushes
    profile: { rise_ms: 200, shape: minimum_jerk }
    loads:)";
    yaml += kLoads;
    yaml += "states:\n";
    for (int i = 0; i < kStates; ++i) {
        const std::string next =
            i + 1 < kStates ? fmt::format("to: s{}", i + 1) : std::string("outcome: done");
        yaml += fmt::format(
            "  - name: s{}\n"
            "    exits:\n"
            "      - {{ when: grip_force > 100 and block.z - block.start.z > 1, outcome: odd }}\n"
            "      - {{ when: time, after_s: {}, {} }}\n",
            i, time / kStates, next);
    }
    yaml += "blocks: [{ name: only, kind: perturbed, perturb: pushes }]\n";
    task::Task out;
    Diagnostics diagnostics;
    read_fields(out, parse_yaml(yaml, "task"), diagnostics);
    diagnostics.throw_if_errors();
    return out;
}

task::TaskPlan plan_of(const scene::Scene& scene, double time) {
    Diagnostics diagnostics;
    task::TaskPlan plan = task::plan_task(task_of(time), scene, diagnostics);
    diagnostics.throw_if_errors();
    plan.trials = task::make_trials(plan.task, 1, 1);
    task::resolve_all(plan, diagnostics);
    diagnostics.throw_if_errors();
    return plan;
}

double median_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

Cost cost_of(const servo::TickTimes& times) {
    return {times.quantile(0.5), times.quantile(0.99), times.quantile(1)};
}

/// One run of the grasp, with or without the task.
Cost measure_run(const measure::BenchSetup& setup, bool with_task, TaskFigures& figures) {
    const scene::Scene scene = measure::grasp_scene(setup);
    measure::Bench bench(scene, measure::grasp_hand(setup), setup);
    const double time = bench.driver().duration();
    const BenchLog log(scene, setup.settings);
    recording::Recorder recorder = log.record(recording::Writing::in_place);
    servo::TickTimes times;
    times.reserve(static_cast<size_t>(time / setup.settings.tick()) + 2);
    frame::Director director;
    task::TaskPlan plan;
    std::optional<task::TaskDirector> trials;
    if (with_task) {
        plan = plan_of(scene, time);
        trials.emplace(plan, 1, setup.settings.tick());
        director = [&](const frame::Frame& last, std::span<const frame::Handle> handles,
                       frame::Commands& commands) { (*trials)(last, handles, commands); };
    }
    bench.run(
        [&](const frame::Frame& frame) {
            recorder.record(frame);
            figures.states = std::max(figures.states, with_task ? frame.phase : 0);
            figures.loads = std::max(figures.loads, static_cast<int>(frame.task.loads.size()));
        },
        director, &times);
    return cost_of(times);
}

/// Time of 20 conditions on a held block, with the refresh of their quantities.
double measure_expressions() {
    task::Quantities quantities{{.fingers = {"thumb", "index"},
                                 .bodies = {"table", "block"},
                                 .joints = {},
                                 .regions = {"start", "goal"},
                                 .hands = {{"left", 3}}}};
    constexpr std::array kTexts{
        "grip_force > 2 and block.z - block.start.z > 5 mm",
        "inside(block, goal) and still(block)",
        "gripped(block, left)",
        "lifted(block, 20 mm)",
        "contact_force(block, table) > 0.5 or index.speed > 50 mm/s",
        "distance(thumb, index) < 60 mm and time_in_state > 0.2",
        "touched(block, index) and not touched(table)",
        "sqrt(index.x ^ 2 + index.y ^ 2) > 0.1",
        "index.normal_force > 1 if time_in_trial > 1 else thumb.normal_force > 1",
        "norm(hand - start) > 45 mm",
    };
    Diagnostics diagnostics;
    std::vector<task::Expression> all;
    for (int i = 0; i < 20; ++i)
        all.push_back(task::Expression::compile(kTexts[static_cast<size_t>(i) % kTexts.size()],
                                                quantities, {}, "when", diagnostics));
    diagnostics.throw_if_errors();
    frame::Frame frame;
    frame.time = std::chrono::seconds(1);
    frame.fingers.resize(2);
    frame.bodies.resize(2);
    frame.contacts.resize(8);
    for (size_t i = 0; i < frame.contacts.size(); ++i) {
        frame.contacts[i].a = 1;
        frame.contacts[i].b = 2 + static_cast<int>(i) % 2;
        frame.contacts[i].normal_force = 1;
    }
    const std::vector<frame::Handle> handles(2);
    constexpr int kTicks = 1000;
    std::vector<double> us;
    volatile double kept = 0;
    for (int batch = 0; batch < 200; ++batch) {
        double sum = 0;
        const double taken = duration_of([&] {
            for (int i = 0; i < kTicks; ++i) {
                frame.grip_force = i % 5;
                quantities.set(task::Quantities::kTimeInState, i * 1e-3);
                quantities.update(frame, handles);
                for (const task::Expression& expression : all)
                    sum += expression(quantities.values());
            }
        });
        us.push_back(1e6 * taken / kTicks);
        kept = kept + sum;
    }
    return median_of(us);
}

}  // namespace

TaskFigures bench_task(const measure::BenchSetup& setup, int pairs,
                       const measure::Progress& progress) {
    TaskFigures out;
    std::vector<double> more;
    std::array<std::vector<Cost>, 2> costs;
    for (int pair = 0; pair < pairs; ++pair) {
        if (progress) progress("with and without a task", static_cast<double>(pair) / pairs);
        for (const bool with_task : {false, true})
            costs[with_task ? 1 : 0].push_back(measure_run(setup, with_task, out));
        more.push_back(costs[1].back().median_us - costs[0].back().median_us);
    }
    const auto middle = [](std::vector<Cost> of) {
        std::sort(of.begin(), of.end(),
                  [](const Cost& a, const Cost& b) { return a.median_us < b.median_us; });
        return of[of.size() / 2];
    };
    out.plain = middle(costs[0]);
    out.task = middle(costs[1]);
    out.more_us = median_of(more);
    out.expressions_us = measure_expressions();
    return out;
}

}  // namespace dihaptic::bench
