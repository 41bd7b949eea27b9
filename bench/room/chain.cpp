#include "bench/chain.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include "base/geometry.h"
#include "base/unit.h"
#include "bench/runge_kutta.h"
#include "model/gravity.h"

namespace dihaptic::bench {
namespace {

constexpr double kLinkLength = 0.06, kLinkMass = 0.02, kLinkThick = 0.01;  // [m], [kg]
constexpr double kChainAngle = 45 * kDegree;                               // at the start [rad]
constexpr int kChainSteps = 10000;

Vec3 along_chain(double angle, double length) {
    return length * Vec3(std::sin(angle), 0, -std::cos(angle));
}

/// The equations of motion of links in a plane, in terms of their angles from the vertical,
/// independent of our dynamics.
class ChainEquations {
  public:
    using State = Eigen::VectorXd;  ///< angles [rad], then their rates [rad/s]

    explicit ChainEquations(int links) : n_(links), coupling_(links, links), weight_(links) {
        // arm j carries the centre of its own link at half its length, and those below at full
        // length
        for (int j = 0; j < n_; ++j) {
            const auto arm = [](int of, int link) {
                return of == link ? 0.5 : of < link ? 1. : 0.;
            };
            weight_[j] = 0;
            for (int i = j; i < n_; ++i) weight_[j] += kLinkMass * kLinkLength * arm(j, i);
            for (int k = 0; k < n_; ++k) {
                coupling_(j, k) = 0;
                for (int i = std::max(j, k); i < n_; ++i)
                    coupling_(j, k) +=
                        kLinkMass * kLinkLength * kLinkLength * arm(j, i) * arm(k, i);
            }
        }
    }

    State at_rest(double angle) const {
        State out = State::Zero(2 * n_);
        out.head(n_).setConstant(angle);
        return out;
    }

    State rate(const State& s) const {
        Eigen::MatrixXd M(n_, n_);
        Eigen::VectorXd f(n_);
        for (int j = 0; j < n_; ++j) {
            f[j] = -model::kGravity * weight_[j] * std::sin(s[j]);
            for (int k = 0; k < n_; ++k) {
                M(j, k) = coupling_(j, k) * std::cos(s[j] - s[k]);
                f[j] -= coupling_(j, k) * std::sin(s[j] - s[k]) * s[n_ + k] * s[n_ + k];
            }
            M(j, j) += kLinkMass / 12 * (kLinkLength * kLinkLength + kLinkThick * kLinkThick);
        }
        State out(2 * n_);
        out << s.tail(n_), M.llt().solve(f);
        return out;
    }

    /// The middle of the last link [m].
    Vec3 end(const State& s) const {
        Vec3 out(0, 2 * kLinkThick * (n_ - 1), 0);
        for (int i = 0; i < n_; ++i)
            out += along_chain(s[i], i + 1 < n_ ? kLinkLength : kLinkLength / 2);
        return out;
    }

  private:
    int n_;
    Eigen::MatrixXd coupling_;
    Eigen::VectorXd weight_;
};

/// Compares the path of the last link with its equations. Depending on how they define velocities,
/// simulators start at rest at the start, half a step before, or a step before; this shift in time
/// does not count as an error.
class EndJudge {
  public:
    EndJudge(int links) : exact_(exact_ends(links, kChainAngle, kJudged + 2 * kStep)) {}

    void see(const Vec3& p_W) {
        ++step_;
        if (step_ * kStep > kJudged) return;
        for (size_t shift = 0; shift < worst_.size(); ++shift)
            worst_[shift] = std::max(worst_[shift], (p_W - exact_[2 * step_ + shift]).norm());
    }
    double error() const { return *std::min_element(worst_.begin(), worst_.end()); }

  private:
    static constexpr double kJudged = 1;  // [s]
    std::vector<Vec3> exact_;
    std::array<double, 3> worst_{};
    size_t step_ = 0;
};

/// Energy between two steps, from the difference of poses; zero when the chain hangs straight down
/// [J].
double energy_between(std::span<const Pose> before, std::span<const Pose> after) {
    double out = energy_of_chain_at(static_cast<int>(after.size()), 90 * kDegree);
    for (size_t i = 0; i < after.size(); ++i) {
        const Vec3 v = (after[i].p - before[i].p) / kStep;
        const Vec3 w_B = rotation_vector(before[i].R.conjugate() * after[i].R) / kStep;
        out += energy_of_link((before[i].p.z() + after[i].p.z()) / 2, v, w_B);
    }
    return out;
}

/// Largest separation of links at their hinges [m].
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
    EndJudge judge(links);
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
        judge.see(X_WB.back().p);
        before.assign(X_WB.begin(), X_WB.end());
        ++step;
        began = Clock::now();
        return true;
    });
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    out.step_us = *middle;
    out.off_mm = 1e3 * judge.error();
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

std::vector<Vec3> exact_ends(int links, double angle, double duration) {
    constexpr int kParts = 5;
    const ChainEquations equations(links);
    const auto rate = [&](const ChainEquations::State& s) { return equations.rate(s); };
    ChainEquations::State s = equations.at_rest(angle);
    std::vector<Vec3> out{equations.end(s)};
    for (int i = 1; i * kStep / 2 <= duration; ++i) {
        for (int k = 0; k < kParts; ++k) s = runge_kutta(s, kStep / 2 / kParts, rate);
        out.push_back(equations.end(s));
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
