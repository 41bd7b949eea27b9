// The interface to the contact solvers: from a problem and a start to impulses and
// statistics.
//
// A solver that misses its tolerance hands over to others (hand_over.h). The statistics tell
// whether another solver answered, and whether even the last one missed. Each solver has a bound on
// counted work and none reads a clock, so that a replay repeats every solve bit for bit.
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

/// Largest residual that counts as success: Residual::judged() of Coulomb's law or, for
/// Stewart-Trinkle, of its own complementarity problem.
constexpr double kTolerance = 1e-8;

/// Least number of sweeps in every solve, however little work it is allowed.
constexpr int kFewestSweeps = 4;
/// Visits per contact: of a sweep over normals and one over friction, and of a step of Newton's
/// method.
constexpr int kVisitsPerSweep = 2;
constexpr int kVisitsPerStep = 12;
/// Newton's method is not started if the work does not suffice for this many steps.
constexpr int kFewestSteps = 6;

/// The outcome of a solve.
struct SolveStats {
    int iterations = 0;
    double residual = 0;    ///< natural map of Coulomb's law over 1 + |q|, for the given problem
    bool fallback = false;  ///< whether a solver other than the requested one answered
    bool missed = false;    ///< whether the impulses used, the best found, miss the tolerance
    bool refused = false;   ///< whether the problem contained values that are not numbers; then
                            ///< there are no impulses
    bool ended =
        false;  ///< whether the work ran out, so that sweeps ended the solve or were cut short
    Route route = Route::none;
    int64_t work = 0;  ///< work done [visits]

    /// Combines several problems of one step: iterations and work are summed, and the worst of each
    /// other value is kept. The route is that of a problem answered by another solver, if any;
    /// among equals, the last in the enumeration.
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

/// Further results of one solve.
struct SolveDetail {
    double lcp_residual = 0;  ///< stewart_trinkle: for its own complementarity problem, as given
};

class ContactSolvers {
  public:
    ContactSolvers();
    ~ContactSolvers();
    ContactSolvers(ContactSolvers&&) noexcept;
    ContactSolvers& operator=(ContactSolvers&&) noexcept;

    /// Reserves memory for problems of this many bodies, contacts and joints, with or without
    /// torsion. Lemke's method, Stewart-Trinkle's last resort, is kept for problems of up to about
    /// `kLemkeContacts` contacts, with the default eight directions.
    void reserve(int bodies, int contacts, bool torsion, int joints = 0);
    static constexpr int kLemkeContacts = 60;

    /// Solves from the start in r and, for rows of joints, in `joints`, and leaves the impulses
    /// there. A problem larger than reserved allocates memory and is solved by sweeps. A
    /// problem with values that are not numbers is refused before any solver starts
    /// (SolveStats::refused).
    void solve(Solver solver, const SolveSettings& settings, const ContactProblem& problem,
               std::span<Impulse> r, std::span<Vec3> joints, SolveStats& stats,
               SolveDetail* detail = nullptr) noexcept;
    /// The same for a problem without joints.
    void solve(Solver solver, const SolveSettings& settings, const ContactProblem& problem,
               std::span<Impulse> r, SolveStats& stats, SolveDetail* detail = nullptr) noexcept {
        solve(solver, settings, problem, r, {}, stats, detail);
    }
    /// Change of a body's velocity by the impulses of the last solve: linear [m/s], then angular
    /// [rad/s].
    Vec6 velocity_change(int body) const noexcept;

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

/// Solves a problem given without bodies. Allocates.
Eigen::VectorXd solve(Solver solver, const SolveSettings& settings, const DelassusProblem& problem,
                      SolveStats& stats, SolveDetail* detail = nullptr);

}  // namespace dihaptic::contact
