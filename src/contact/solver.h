// The door to all contact solvers but Bullet's own: a problem and a start in, impulses and what was
// achieved out.
//
// A solver that misses its tolerance hands over to Newton on the cone, that, in three dimensions,
// to Newton after an answer on a coarse polygon, that to staggered projections, and those to Newton
// again after many projected Gauss-Seidel sweeps; that another
// answered is told, and when even the last one missed. Each has a bound on counted work and none
// reads a clock, so that replay repeats every solve bit for bit.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "contact/problem.h"
#include "contact/route.h"
#include "contact/solver_settings.h"

namespace dihaptic::contact {

/// Success is a residual up to this: Residual::judged() of Coulomb's law; for Stewart-Trinkle of
/// its own complementarity problem.
constexpr double kTolerance = 1e-8;

/// What a solve achieved.
struct SolveStats {
    int iterations = 0;
    double residual = 0;    ///< natural map of Coulomb's law over 1 + |q|, of the problem as given
    bool fallback = false;  ///< another solver than the one asked for answered
    bool missed = false;    ///< the impulses in use, the best found, are not within tolerance
    bool refused = false;   ///< the problem held what is no number: there are no impulses
    Route route = Route::none;

    /// Of several problems of one step: the worst of each; the route of one that another solver
    /// answered, where there is one, and otherwise the last of the list.
    void join(const SolveStats& other) noexcept {
        if (std::pair(other.fallback, other.route) > std::pair(fallback, route))
            route = other.route;
        iterations = std::max(iterations, other.iterations);
        residual = std::max(residual, other.residual);
        fallback = fallback || other.fallback;
        missed = missed || other.missed;
        refused = refused || other.refused;
    }
};

/// What there is to know about one solve beyond its statistics.
struct SolveDetail {
    double lcp_residual = 0;  ///< stewart_trinkle: of its own complementarity problem, as given
};

class ContactSolvers {
  public:
    ContactSolvers();
    ~ContactSolvers();
    ContactSolvers(ContactSolvers&&) noexcept;
    ContactSolvers& operator=(ContactSolvers&&) noexcept;

    /// Memory for problems of so many bodies and contacts, with torsion or without. Stewart-Trinkle
    /// keeps its last resort, Lemke's method, for problems up to `kLemkeContacts`.
    void reserve(int bodies, int contacts, bool torsion);
    static constexpr int kLemkeContacts = 60;

    /// Solves from the start in r; leaves the impulses in r. Not for sequential_impulse. False:
    /// more than what was reserved; nothing is changed. A problem with what is no number in it is
    /// refused before any solver starts: SolveStats::refused.
    bool solve(Solver solver, const PolygonSettings& polygon, const ContactProblem& problem,
               std::span<Impulse> r, SolveStats& stats, SolveDetail* detail = nullptr) noexcept;
    /// Change of a body's velocity by the impulses of the last solve: linear [m/s], angular
    /// [rad/s].
    Eigen::Matrix<double, 6, 1> velocity_change(int body) const noexcept;

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

/// The same for a problem without bodies. Allocates.
Eigen::VectorXd solve(Solver solver, const PolygonSettings& polygon, const DelassusProblem& problem,
                      SolveStats& stats, SolveDetail* detail = nullptr);

}  // namespace dihaptic::contact
