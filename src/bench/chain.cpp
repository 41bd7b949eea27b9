#include "bench/chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "base/geometry.h"
#include "base/unit.h"
#include "model/gravity.h"

namespace dihaptic::bench {
namespace {

constexpr double kLinkLength = 0.06, kLinkMass = 0.02, kLinkThick = 0.01;  // [m], [kg]
constexpr double kChainAngle = 45 * kDegree;                               // at the start
constexpr int kChainSteps = 10000;

Vec3 along_chain(double angle, double length) {
    return length * Vec3(std::sin(angle), 0, -std::cos(angle));
}

/// Energy between two steps, by the difference of poses; zero where the chain hangs [J].
double energy_between(std::span<const Pose> before, std::span<const Pose> after) {
    double out = energy_of_chain_at(static_cast<int>(after.size()), 90 * kDegree);
    for (size_t i = 0; i < after.size(); ++i) {
        const Vec3 v = (after[i].p - before[i].p) / kStep;
        const Vec3 w_B = rotation_vector(before[i].R.conjugate() * after[i].R) / kStep;
        out += energy_of_link((before[i].p.z() + after[i].p.z()) / 2, v, w_B);
    }
    return out;
}

/// How far the links are apart at their hinges [m].
double apart(const scene::Scene& scene, std::span<const Pose> X_WB) {
    double most = 0;
    for (size_t i = 0; i < X_WB.size(); ++i) {
        const Vec3& p_W = scene.joints[i].position;
        const auto now = [&](size_t body) -> Vec3 {
            return X_WB[body] * (scene.bodies[body].pose().inverse() * p_W);
        };
        most = std::max(most, (now(i) - (i == 0 ? p_W : now(i - 1))).norm());
    }
    return most;
}

ChainFigures measure_chain(const Simulator& simulator, int links) {
    using Clock = std::chrono::steady_clock;
    const Trial trial{chain(links, kChainAngle), {}};
    ChainFigures out;
    out.simulator = simulator.name;
    out.links = links;
    std::vector<Pose> before;
    for (const scene::Body& body : trial.scene.bodies) before.push_back(body.pose());
    std::vector<double> times;
    double first = 0, last = 0, most = 0;
    constexpr int kMean = kChainSteps / 5;
    int step = 0;
    Clock::time_point began = Clock::now();
    simulator.run(trial, kChainSteps, [&](std::span<const Pose> X_WB) {
        times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - began).count());
        const double energy = energy_between(before, X_WB);
        most = std::max(most, energy);
        if (step < kMean) first += energy;
        if (step >= kChainSteps - kMean) last += energy;
        out.apart_mm = std::max(out.apart_mm, 1e3 * apart(trial.scene, X_WB));
        before.assign(X_WB.begin(), X_WB.end());
        ++step;
        began = Clock::now();
        return true;
    });
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    out.step_us = *middle;
    const double start = energy_of_chain_at(links, kChainAngle);
    out.energy = last / first - 1;
    out.energy_above = most / start - 1;
    return out;
}

}  // namespace

scene::Scene chain(int links, double angle) {
    scene::Scene out;
    for (int i = 0; i < links; ++i) {
        scene::Body link;
        link.name = fmt::format("link {}", i + 1);
        link.shape = scene::Shape::box({kLinkLength, kLinkThick, kLinkThick});
        link.mass = kLinkMass;
        link.position =
            Vec3(0, 2 * kLinkThick * i, 0) + along_chain(angle, (i + 0.5) * kLinkLength);
        link.rotation = {0, std::numbers::pi / 2 - angle, 0};
        scene::Joint hinge;
        hinge.name = fmt::format("hinge {}", i + 1);
        if (i > 0) hinge.between.push_back(out.bodies.back().name);
        hinge.between.push_back(link.name);
        hinge.position = along_chain(angle, i * kLinkLength);
        hinge.axis = -Vec3::UnitY();
        out.bodies.push_back(link);
        out.joints.push_back(hinge);
    }
    return out;
}

double energy_of_link(double height, const Vec3& v, const Vec3& w_B) {
    constexpr double kAcross = kLinkThick * kLinkThick;
    constexpr double kAlong = kLinkLength * kLinkLength;
    const Vec3 inertia = kLinkMass / 12 * Vec3(2 * kAcross, kAlong + kAcross, kAlong + kAcross);
    return kLinkMass * model::kGravity * height + kLinkMass * v.squaredNorm() / 2 +
           w_B.dot(inertia.cwiseProduct(w_B)) / 2;
}

double energy_of_chain_at(int links, double angle) {
    const double highest = kLinkMass * model::kGravity * kLinkLength * links * links / 2;
    return highest * (1 - std::cos(angle));
}

std::vector<ChainFigures> bench_chain(const std::vector<Simulator>& simulators,
                                      const std::vector<int>& links,
                                      const measure::Progress& progress) {
    std::vector<ChainFigures> out;
    const auto all = static_cast<double>(links.size() * simulators.size());
    for (const Simulator& simulator : simulators) {
        for (const int count : links) {
            progress(fmt::format("{}, {} links", simulator.name, count),
                     static_cast<double>(out.size()) / all);
            out.push_back(measure_chain(simulator, count));
        }
    }
    return out;
}

}  // namespace dihaptic::bench
