// Semismooth Newton on a contact law (law.h), inside a proximal loop: each proximal step makes a
// singular problem regular, and at convergence r = r_k leaves no regularisation in the answer.
//
// At first steps are full, the regularisation follows the residual, and a proximal step is done
// when its equation's error has fallen to a fifth. One that does not converge is undone, a few
// projected Gauss-Seidel sweeps move on, and the regularisation grows tenfold. When all that takes
// too long, it starts again elsewhere.
#pragma once

#include <array>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "contact/law.h"

namespace dihaptic::contact {

/// How an iterative solve ended.
struct Outcome {
    int iterations = 0;
    double residual = std::numeric_limits<double>::infinity();  ///< as the tolerance counts it
    bool converged = false;
};

/// Natural map of a law, relative, in two units: those of the problem as given, and those of the
/// scaled system, in which no unit counts.
struct Residual {
    double scaled = std::numeric_limits<double>::infinity();  ///< over |q^|
    double given = std::numeric_limits<double>::infinity();   ///< over 1 + |q|

    /// What tolerances are compared with: as given; and so that small units do not make that easy,
    /// a hundredth of the other. Not all of it, since loads may be so small that four coplanar
    /// contacts disagree by more, from rounding in their gaps.
    double judged() const noexcept { return std::max(given, 0.01 * scaled); }
};

/// What residuals are relative to.
struct Load {
    double scaled = 0;  ///< |q^|
    double given = 0;   ///< |q|

    /// From squared norms.
    Residual residual(double scaled_squared, double given_squared) const noexcept {
        return {std::sqrt(scaled_squared) / (scaled > 0 ? scaled : 1),
                std::sqrt(given_squared) / (1 + given)};
    }
};

template <class System>
struct NewtonMemory {
    using Vec = typename System::Vec;
    std::vector<Vec> u, r_k, d, best;
    std::vector<Linearised<System::D>> linearised;

    void reserve(size_t contacts) {
        for (auto* v : {&u, &r_k, &d, &best}) v->reserve(contacts);
        linearised.reserve(contacts);
    }
    void resize(size_t contacts) {
        for (auto* v : {&u, &r_k, &d, &best}) v->resize(contacts);
        linearised.resize(contacts);
    }
};

template <class System>
Load load(const System& system) noexcept {
    Load out;
    for (size_t j = 0; j < system.size(); ++j) {
        out.scaled += system.q(j).squaredNorm();
        out.given += (system.q(j) / system.unit(j)).squaredNorm();
    }
    return {std::sqrt(out.scaled), std::sqrt(out.given)};
}

/// Iterations aim so far below the tolerance that an answer at the edge of it is rare.
constexpr double kTarget = 1e-2;
/// Within tolerance, iterations end when this many of them left more than this share of the best
/// residual: rounding allows no more.
constexpr double kStalledShare = 0.5;
constexpr int kStalledIterations = 2;

/// One way to run the proximal loop.
struct NewtonStart {
    enum class From { given, zero, scattered } from;
    double rho;
    int most_steps;
    int trial_steps;  ///< a proximal step is given up when its error is larger then
    int most_inner;   ///< or not small after so many
    /// The next rho is in proportion to the residual, as in Levenberg and Marquardt's method; else
    /// a tenth, after proximal steps that took few Newton steps.
    bool rho_follows;
    int halvings;  ///< of a Newton step that makes the error grow fourfold, at most
    int sweeps;    ///< of projected Gauss-Seidel, before; they find most of what slides
};
/// As given, from zero, and from impulses scattered at random: where one start cycles, four of ten
/// others do not. Chosen by the fewest hand-overs in a million problems of shaken grasps (soak of
/// `measure`).
constexpr auto kNewtonStarts = [] {
    using From = NewtonStart::From;
    std::array<NewtonStart, 14> out{};
    out[0] = {From::given, 1e-3, 40, 6, 12, true, 0, 2};
    out[1] = {From::zero, 1e-2, 60, 15, 30, true, 4, 0};
    for (size_t i = 2; i < out.size(); ++i) {
        const bool full = i % 2 == 1;
        out[i] = {From::scattered, full ? 1e-3 : 1e-2, 100, 20, 40, true, full ? 0 : 4, 2};
    }
    return out;
}();

/// Solves `law` for r [scaled], starting from r, until `measure(r, u)` is at most kTarget of
/// `tolerance`, from so many of its starts at most. Leaves the best r found, and its velocity in
/// memory.u.
template <class System, class Law, class Measure>
Outcome proximal_newton(System& system, const Law& law, std::span<typename System::Vec> r,
                        double tolerance, NewtonMemory<System>& memory, const Measure& measure,
                        std::span<const NewtonStart> starts = kNewtonStarts) {
    using Vec = typename System::Vec;
    constexpr double kSafe = 0.1;  // what a start that runs out of steps must have reached
    constexpr double kLeastRho = 1e-7;
    constexpr double kMostRho = 1.0;
    constexpr double kRhoOfResidual = 0.3;
    constexpr double kReduced = 0.05;  // of the squared error
    constexpr double kReducedMuch = 1e-4;
    constexpr double kGrown = 4;
    constexpr int kFewSteps = 4;
    constexpr int kRescueSweeps = 5;
    constexpr double kScatter = 0.3;  // of |q|
    // contacts times steps, of all starts: a heap that jams must not stop the tick for long
    constexpr size_t kMostWork = 32000;

    const size_t n = system.size();
    std::minstd_rand random;  // the same numbers in every solve: replay repeats it
    const auto most_steps = static_cast<int>(kMostWork / std::max<size_t>(n, 1));
    memory.resize(n);
    Outcome out;
    double residual = 0;
    bool is_best = false;  // r, and memory.u is its velocity
    int stalled = 0;
    const auto judge = [&] {
        system.velocity(r, memory.u);
        residual = measure(std::span<const Vec>(r), std::span<const Vec>(memory.u));
        if (out.residual <= tolerance && residual > kStalledShare * out.residual) ++stalled;
        is_best = residual < out.residual;
        if (is_best) {
            out.residual = residual;
            std::copy(r.begin(), r.end(), memory.best.begin());
        }
        out.converged = out.residual <= kTarget * tolerance || stalled >= kStalledIterations;
        return out.converged;
    };
    const auto linearise = [&](double rho) {
        double error = 0;
        for (size_t j = 0; j < n; ++j) {
            const Vec u = memory.u[j] + rho * (r[j] - memory.r_k[j]);
            error += law.template linearise<System::D>(system.scale(j), r[j], u, rho,
                                                       memory.linearised[j], j);
        }
        return error;
    };
    const auto restart_proximal = [&](double rho) {
        std::copy(r.begin(), r.end(), memory.r_k.begin());
        return linearise(rho);
    };
    const auto step_by = [&](double share) {
        for (size_t j = 0; j < n; ++j) r[j] += share * memory.d[j];
        ++out.iterations;
        return judge();
    };

    std::copy(r.begin(), r.end(), memory.best.begin());
    judge();
    for (const NewtonStart& start : starts) {
        if (out.converged || out.iterations >= most_steps) break;
        if (start.from == NewtonStart::From::zero) {
            for (Vec& impulse : r) impulse.setZero();
        } else if (start.from == NewtonStart::From::scattered) {
            const double size = kScatter * load(system).scaled;
            for (Vec& impulse : r) {
                for (double& value : impulse)
                    value = size * (2.0 * static_cast<double>(random()) / random.max() - 1);
            }
        }
        if (start.from != NewtonStart::From::given || start.sweeps > 0) {
            system.sweep(law, r, start.sweeps);
            if (judge()) break;
        }
        double rho = start.rho;
        double first = restart_proximal(rho);
        double error = first;
        int inner = 0;
        for (int step = 0; step < start.most_steps && out.iterations < most_steps; ++step) {
            system.newton_step(memory.linearised, memory.d);
            ++inner;
            if (step_by(1)) break;
            const double before = error;
            error = linearise(rho);
            double share = 1;
            for (int h = 0; h < start.halvings && !(error <= kGrown * before); ++h) {
                share /= 2;
                if (step_by(-share)) break;
                error = linearise(rho);
            }
            if (out.converged) break;
            if (error <= (start.rho_follows ? kReduced : kReducedMuch) * first) {
                if (start.rho_follows) {
                    rho = std::clamp(kRhoOfResidual * residual, kLeastRho, rho);
                } else if (inner <= kFewSteps) {
                    rho = std::max(rho / 10, kLeastRho);
                }
                error = first = restart_proximal(rho);
                inner = 0;
            } else if (inner >= start.most_inner ||
                       (inner >= start.trial_steps && error > kGrown * first) ||
                       !std::isfinite(error)) {
                std::copy(memory.r_k.begin(), memory.r_k.end(), r.begin());
                system.sweep(law, r, kRescueSweeps);
                rho = std::min(rho * 10, kMostRho);
                if (judge()) break;
                error = first = restart_proximal(rho);
                inner = 0;
            }
        }
        out.converged = out.converged || out.residual <= kSafe * tolerance;
    }
    out.converged = out.converged || out.residual <= tolerance;
    if (!is_best) {
        std::copy(memory.best.begin(), memory.best.end(), r.begin());
        system.velocity(r, memory.u);
    }
    return out;
}

/// Residual of Coulomb's law. When it is above `enough` as given, that says all, and the scaled one
/// is left at zero.
template <class System>
Residual coulomb_residual(const System& system, std::span<const typename System::Vec> r,
                          std::span<const typename System::Vec> u, const Load& load,
                          double enough = std::numeric_limits<double>::infinity()) noexcept {
    using Vec = typename System::Vec;
    double given = 0;
    for (size_t j = 0; j < system.size(); ++j) {
        const double unit = system.unit(j);
        const Vec r_given = r[j] * unit;
        const Vec u_given = u[j] * (1 / unit);
        given += natural_map_squared<System::D>(r_given, u_given, system.scale(j).mu);
    }
    const Residual far = load.residual(0, given);
    if (far.given > enough) return far;
    double scaled = 0;
    for (size_t j = 0; j < system.size(); ++j)
        scaled += natural_map_squared<System::D>(r[j], u[j], system.scale(j).mu);
    return load.residual(scaled, given);
}

/// Coulomb's law by proximal_newton.
template <class System>
Outcome newton(System& system, std::span<typename System::Vec> r, double tolerance,
               NewtonMemory<System>& memory, std::span<const NewtonStart> starts = kNewtonStarts) {
    using Vec = typename System::Vec;
    const Load size = load(system);
    return proximal_newton(
        system, law::Coulomb{}, r, tolerance, memory,
        [&](std::span<const Vec> impulse, std::span<const Vec> u) {
            return coulomb_residual(system, impulse, u, size, tolerance).judged();
        },
        starts);
}

}  // namespace dihaptic::contact
