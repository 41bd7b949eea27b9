// The interface to the contact solvers, which compute impulses and statistics from a problem and
// initial impulses.
//
// A solver that misses its tolerance hands over to others (hand_over.h). The statistics say whether
// another solver provided the answer, and whether even the last solver missed the tolerance. Each
// solver's work is counted and bounded, and none reads a clock, so that a replay repeats every
// solve bit for bit.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "contact/problem.h"
#include "contact/route.h"
#include "contact/solver_settings.h"
#include "contact/work.h"

namespace dihaptic::contact {

/// Largest residual that counts as a success: Residual::judged() for Coulomb's law or, with
/// Stewart-Trinkle, for its own complementarity problem.
constexpr double kTolerance = 1e-8;

/// Minimum number of sweeps in every solve, however little work is allowed.
constexpr int kFewestSweeps = 4;
/// Visits per contact of a sweep (one over normals and one over friction), and of a Newton step.
constexpr int kVisitsPerSweep = 2;
constexpr int kVisitsPerStep = 12;
/// Newton's method is not started if the work budget does not suffice for this many steps.
constexpr int kFewestSteps = 6;

/// Statistics of a solve.
struct SolveStats {
    int iterations = 0;
    double residual = 0;    ///< norm of Coulomb's natural map over 1 + |q|, for the given problem
    bool fallback = false;  ///< whether the answer is from a solver other than the requested one
    bool missed = false;    ///< whether the impulses used (the best found) miss the tolerance
    bool refused = false;   ///< whether the problem was refused because it contained values that
                            ///< are not numbers; there are then no impulses
    bool ended =
        false;  ///< whether work ran out, so that sweeps finished the solve or were cut short
    Route route = Route::none;
    int64_t work = 0;  ///< work done [visits]

    /// Combines the statistics of several problems in one step: iterations and work are summed, and
    /// the worst of every other value is kept. The route is that of a problem answered by another
    /// solver, if there is one; in a tie, the route that comes last in the enumeration is used.
    void join(const SolveStats& other) noexcept {
        if (std::pair(other.fallback, other.route) > std::pair(fallback, route))
            route = other.route;
        iterations += other.iterations;
        work += other.work;
        residual = std::max(residual, other.residual);
        fallback = fallback || other.fallback;
        missed = missed || other.missed;
        refused = refused || other.refused;
        ended = ended || other.ended;
    }
};

/// Additional results of one solve.
struct SolveDetail {
    double lcp_residual = 0;  ///< stewart_trinkle: residual of its own problem, in given units
};

class ContactSolvers {
  public:
    ContactSolvers();
    ~ContactSolvers();
    ContactSolvers(ContactSolvers&&) noexcept;
    ContactSolvers& operator=(ContactSolvers&&) noexcept;

    /// Reserves memory for problems of this many bodies, contacts and joints, with or without
    /// torsion. Memory for Lemke's method, the last resort of Stewart-Trinkle, suffices for
    /// problems of up to about `kLemkeContacts` contacts, with the default eight directions.
    void reserve(int bodies, int contacts, bool torsion, int joints = 0);
    static constexpr int kLemkeContacts = 60;

    /// Solves the problem, starting from the impulses in r and, for rows of joints, in `joints`,
    /// and replaces them with the answer. For a problem larger than reserved, allocates memory and
    /// solves by sweeps. A problem with values that are not numbers is refused before any solver
    /// starts (SolveStats::refused).
    void solve(Solver solver, const SolveSettings& settings, const ContactProblem& problem,
               std::span<Impulse> r, std::span<Vec3> joints, SolveStats& stats,
               SolveDetail* detail = nullptr) noexcept;
    /// Solves a problem without joints.
    void solve(Solver solver, const SolveSettings& settings, const ContactProblem& problem,
               std::span<Impulse> r, SolveStats& stats, SolveDetail* detail = nullptr) noexcept {
        solve(solver, settings, problem, r, {}, stats, detail);
    }
    /// Velocity change of a body due to the impulses of the last solve: linear [m/s], then angular
    /// [rad/s].
    Vec6 velocity_change(int body) const noexcept;

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

/// Solves a problem given without bodies. Allocates memory.
Eigen::VectorXd solve(Solver solver, const SolveSettings& settings, const DelassusProblem& problem,
                      SolveStats& stats, SolveDetail* detail = nullptr);

}  // namespace dihaptic::contact
