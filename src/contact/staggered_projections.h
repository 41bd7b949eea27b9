// Staggered projections (Kaufman, Sueda, James and Pai 2008): Coulomb's law as two convex problems
// that wait for each other,
//
//     friction:  the tangential impulses that dissipate most, on discs of radius mu r_N
//     contact:   the normal impulses that keep bodies apart, with that friction
//
// repeated until they agree. Each is solved exactly, by the proximal Newton method, which for a
// convex problem finds the active set; inexact inner solutions stall the outer loop at their own
// error. Contacts without load are no part of the friction problem. Anderson acceleration of the
// normal impulses shortens the loop; what still wanders is moved on by projected Gauss-Seidel
// sweeps. Every pair ends with a contact projection, so none leaves bodies approaching; the best
// pair is the answer.
#pragma once

#include "contact/anderson.h"
#include "contact/newton.h"

namespace dihaptic::contact {

template <class System>
struct StaggeredMemory {
    NewtonMemory<System> newton;
    Anderson anderson;
    std::vector<typename System::Vec> best;
    std::vector<double> normal;  ///< that friction is solved for
    std::vector<double> image;   ///< that contact answers

    void reserve(size_t contacts) {
        newton.reserve(contacts);
        anderson.reserve(contacts);
        best.reserve(contacts);
        normal.reserve(contacts);
        image.reserve(contacts);
    }
};

/// Starts from r; leaves the best pair in r and its velocity in memory.newton.u.
template <class System>
Outcome staggered_projections(System& system, std::span<typename System::Vec> r, double tolerance,
                              int most_iterations, StaggeredMemory<System>& memory) {
    using Vec = typename System::Vec;
    // Of |q|; kTarget of it is aimed at. No need to be far more exact than the loop has become.
    constexpr double kInnerTolerance = 1e-10;
    constexpr double kInnerOfLast = 1e-3;
    // Loads that nothing determines must not wander from pair to pair: a large rho that falls
    // slowly keeps the inner answer near its start.
    constexpr NewtonStart kInnerStart[] = {
        {NewtonStart::From::given, 1e-3, 40, 6, 12, false, 0, 0}};
    constexpr int kPlainIterations = 3;
    constexpr int kPatience = 15;  // iterations before sweeps move on
    constexpr int kSweeps = 200;
    const size_t n = system.size();
    const Load size = load(system);
    memory.best.resize(n);
    memory.normal.resize(n);
    memory.image.resize(n);
    memory.anderson.start(n);
    Outcome out;
    double last = std::numeric_limits<double>::infinity();
    const auto solve = [&](const auto& law) {
        const double enough = std::isfinite(last) ? kInnerOfLast * last : 0;
        proximal_newton(
            system, law, r, std::max(kInnerTolerance, enough) * size.scaled, memory.newton,
            [&](std::span<const Vec> impulse, std::span<const Vec> u) {
                double error = 0;
                for (size_t j = 0; j < n; ++j)
                    error += law.template residual<System::D>(system.scale(j), impulse[j], u[j], j);
                return std::sqrt(error);
            },
            kInnerStart);
    };

    int stalled = 0;
    int plain = kPlainIterations;
    memory.newton.resize(n);
    const auto judge = [&] {
        const double residual =
            coulomb_residual(system, std::span<const Vec>(r), std::span<const Vec>(memory.newton.u),
                             size, tolerance)
                .judged();
        if (residual < out.residual) {
            out.residual = residual;
            std::copy(r.begin(), r.end(), memory.best.begin());
        }
        out.converged = out.residual <= tolerance;
        return residual;
    };
    system.velocity(r, memory.newton.u);
    std::copy(r.begin(), r.end(), memory.best.begin());
    judge();
    for (size_t j = 0; j < n; ++j) memory.normal[j] = std::max(0.0, r[j][0]);
    if (out.residual > kTarget * tolerance) {
        solve(law::NormalOnly{});  // a first guess of the loads, with the friction of the start
        for (size_t j = 0; j < n; ++j) memory.normal[j] = r[j][0];
    }
    while (out.residual > kTarget * tolerance && out.iterations < most_iterations) {
        ++out.iterations;
        const law::FrictionOnly friction{memory.normal};
        for (size_t j = 0; j < n; ++j) {
            r[j][0] = memory.normal[j];
            friction.project<System::D>(system.scale(j), r[j], j);
        }
        solve(friction);
        solve(law::NormalOnly{});
        const double residual = judge();
        if (residual <= kTarget * tolerance) break;
        if (residual <= tolerance && residual > kStalledShare * last &&
            ++stalled >= kStalledIterations)
            break;
        if (residual > 2 * last) memory.anderson.forget();
        last = residual;
        if (out.iterations % kPatience == 0) {
            system.sweep(law::Coulomb{}, r, kSweeps);
            for (size_t j = 0; j < n; ++j) memory.normal[j] = r[j][0];
            memory.anderson.forget();
            plain = kPlainIterations;
            continue;
        }
        for (size_t j = 0; j < n; ++j) memory.image[j] = r[j][0];
        if (plain > 0) {
            --plain;
            // Coulomb's law may have several solutions: begin gently, to find the one nearest
            memory.normal.swap(memory.image);
            continue;
        }
        memory.anderson.advance(memory.normal, memory.image);
        for (double& value : memory.normal) value = std::max(0.0, value);
    }
    std::copy(memory.best.begin(), memory.best.end(), r.begin());
    system.velocity(r, memory.newton.u);
    return out;
}

}  // namespace dihaptic::contact
