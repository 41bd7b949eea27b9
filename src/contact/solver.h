// The interface to all contact solvers but Bullet's own: takes a problem and a start, and returns
// impulses and statistics.
//
// A solver that misses its tolerance hands over to Newton's method on the cone; that, in three
// dimensions, to Newton's method started from an answer on a coarse polygon; that to staggered
// projections; and those to Newton's method again, after many projected Gauss-Seidel sweeps. It is
// reported if another solver answered, and if even the last one missed. Each has a bound on counted
// work and none reads a clock, so that replay repeats every solve bit for bit.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "contact/problem.h"
#include "contact/route.h"
#include "contact/solver_settings.h"

namespace dihaptic::contact {

/// Largest residual that counts as success: Residual::judged() of Coulomb's law or, for
/// Stewart-Trinkle, of its own complementarity problem.
constexpr double kTolerance = 1e-8;

/// What a solve achieved.
struct SolveStats {
    int iterations = 0;
    double residual = 0;    ///< natural map of Coulomb's law over 1 + |q|, of the problem as given
    bool fallback = false;  ///< a solver other than the one asked for answered
    bool missed = false;    ///< the impulses in use, the best found, miss the tolerance
    bool refused = false;   ///< the problem held values that are not numbers: there are no impulses
    Route route = Route::none;

    /// Combines several problems of one step: the worst of each value. The route is that of a
    /// problem that another solver answered, if any; among equals, the last in the enumeration.
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

/// Further results of one solve.
struct SolveDetail {
    double lcp_residual = 0;  ///< stewart_trinkle: of its own complementarity problem, as given
};

class ContactSolvers {
  public:
    ContactSolvers();
    ~ContactSolvers();
    ContactSolvers(ContactSolvers&&) noexcept;
    ContactSolvers& operator=(ContactSolvers&&) noexcept;

    /// Reserves memory for problems of this many bodies and contacts, with or without torsion.
    /// Lemke's method, Stewart-Trinkle's last resort, is kept for problems up to about
    /// `kLemkeContacts`, with the default eight directions.
    void reserve(int bodies, int contacts, bool torsion);
    static constexpr int kLemkeContacts = 60;

    /// Solves from the start in r, and leaves the impulses in r. Not for sequential_impulse. False
    /// if the problem is larger than reserved; nothing is changed then. A problem with values that
    /// are not numbers is refused before any solver starts: SolveStats::refused.
    bool solve(Solver solver, const PolygonSettings& polygon, const ContactProblem& problem,
               std::span<Impulse> r, SolveStats& stats, SolveDetail* detail = nullptr) noexcept;
    /// Change of a body's velocity by the impulses of the last solve: linear [m/s], then angular
    /// [rad/s].
    Eigen::Matrix<double, 6, 1> velocity_change(int body) const noexcept;

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

/// Solves a problem that is given without bodies. Allocates.
Eigen::VectorXd solve(Solver solver, const PolygonSettings& polygon, const DelassusProblem& problem,
                      SolveStats& stats, SolveDetail* detail = nullptr);

}  // namespace dihaptic::contact
