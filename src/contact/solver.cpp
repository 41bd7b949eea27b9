#include "contact/solver.h"

#include "contact/body_system.h"
#include "contact/delassus_system.h"
#include "contact/newton.h"
#include "contact/staggered_projections.h"

namespace dihaptic::contact {
namespace {

constexpr int kMostStaggeredIterations = 200;
constexpr int kLastSweeps = 2000;
/// As a fallback: pairs times contacts times contacts, and sweeps times contacts.
constexpr size_t kMostStaggeredWork = 20'000;
constexpr size_t kMostSweepWork = 60'000;

template <class System>
struct SolverMemory {
    StaggeredMemory<System> staggered;  // its Newton part serves all
    StewartTrinkleMemory<System> stewart_trinkle;
    std::vector<typename System::Vec> r;

    void reserve(size_t contacts, size_t lemke_contacts) {
        staggered.reserve(contacts);
        stewart_trinkle.reserve(contacts, lemke_contacts);
        r.reserve(contacts);
    }
};

/// Leaves the answer in memory.r.
template <class System>
void solve_system(Solver solver, const PolygonSettings& polygon, System& system,
                  SolverMemory<System>& memory, SolveStats& stats, SolveDetail* detail) {
    using Vec = typename System::Vec;
    const std::span<Vec> r(memory.r);
    NewtonMemory<System>& newton_memory = memory.staggered.newton;
    const Load size = load(system);
    const size_t n = std::max<size_t>(r.size(), 1);
    newton_memory.resize(r.size());
    const auto cone_residual = [&] {
        system.velocity(r, newton_memory.u);
        return coulomb_residual(system, std::span<const Vec>(r),
                                std::span<const Vec>(newton_memory.u), size);
    };
    const auto project = [&] {
        for (size_t j = 0; j < r.size(); ++j)
            law::Coulomb::project<System::D>(system.scale(j), r[j], j);
    };
    project();

    Outcome outcome;
    stats.route = Route::newton;
    if (solver == Solver::staggered_projections) {
        stats.route = Route::staggered_projections;
        outcome = staggered_projections(system, r, kTolerance, kMostStaggeredIterations,
                                        memory.staggered);
    } else if (solver == Solver::stewart_trinkle) {
        StewartTrinkle<System> method(system, polygon, kTolerance, memory.stewart_trinkle);
        const StewartTrinkleOutcome answer = method.solve(r);
        outcome = answer;
        stats.route = answer.route;
        if (detail != nullptr) *detail = {answer.lcp_residual};
    } else {
        outcome = newton(system, r, kTolerance, newton_memory);
    }
    if (outcome.iterations == 0) stats.route = r.empty() ? Route::none : Route::start;
    stats.iterations = outcome.iterations;
    stats.fallback = !outcome.converged;
    const auto hand_over = [&](Route route, const auto& solve) {
        if (outcome.converged) return;
        outcome = solve();
        stats.iterations += outcome.iterations;
        stats.route = route;
    };
    if (solver != Solver::newton)
        hand_over(Route::newton, [&] { return newton(system, r, kTolerance, newton_memory); });
    if (solver != Solver::stewart_trinkle && System::D == 3) {
        // where no start leads to an answer on the cone, an answer on a coarse polygon, turned with
        // sliding, is found, and is near one
        hand_over(Route::coarse_polygon, [&] {
            constexpr PolygonSettings kCoarse{4, DirectionFrame::sliding};
            StewartTrinkle<System> method(system, kCoarse, kTolerance, memory.stewart_trinkle);
            const int steps = method.solve_by_newton(r).iterations;
            Outcome near =
                newton(system, r, kTolerance, newton_memory, std::span(kNewtonStarts).first(1));
            near.iterations += steps;
            return near;
        });
    }
    if (solver != Solver::staggered_projections) {
        hand_over(Route::staggered_projections, [&] {
            const auto pairs = static_cast<int>(kMostStaggeredWork / (n * n));
            return staggered_projections(
                system, r, kTolerance, std::min(pairs, kMostStaggeredIterations), memory.staggered);
        });
    }
    hand_over(Route::sweeps, [&] {
        const int sweeps = std::min(kLastSweeps, static_cast<int>(kMostSweepWork / n));
        system.sweep(law::Coulomb{}, r, sweeps);
        Outcome last = newton(system, r, kTolerance, newton_memory);
        last.iterations += sweeps;
        return last;
    });
    // what is left of an error shall not pull: impulses end inside the cone, unless that small
    // change is too much for a problem so delicate
    std::copy(r.begin(), r.end(), newton_memory.best.begin());
    project();
    Residual residual = cone_residual();
    if (!(residual.judged() <= kTolerance)) {
        const auto swap = [&] {
            std::swap_ranges(r.begin(), r.end(), newton_memory.best.begin());
            return cone_residual();
        };
        const Residual unprojected = swap();
        residual = unprojected.judged() <= kTolerance ? unprojected : swap();
    }
    stats.residual = residual.given;
    // an answer of Stewart and Trinkle's own is one of another problem
    stats.missed =
        (solver != Solver::stewart_trinkle || stats.fallback) && !(residual.judged() <= kTolerance);
}

template <int D>
struct BodyMemory {
    BodySystem<D> system;
    SolverMemory<BodySystem<D>> solver;

    void reserve(int bodies, int contacts) {
        system.reserve(bodies, contacts);
        solver.reserve(static_cast<size_t>(contacts),
                       static_cast<size_t>(std::min(contacts, ContactSolvers::kLemkeContacts)));
    }

    bool solve(Solver kind, const PolygonSettings& polygon, const ContactProblem& problem,
               std::span<Impulse> r, SolveStats& stats, SolveDetail* detail) {
        if (!system.assemble(problem)) return false;
        solver.r.resize(r.size());
        if (!system.is_finite()) {
            for (Impulse& impulse : r) impulse.setZero();
            for (auto& impulse : solver.r) impulse.setZero();
            system.body_velocity(solver.r);
            stats.missed = stats.refused = true;
            return true;
        }
        const auto spin_unit = [&](size_t j) { return problem.contacts[j].torsion_radius; };
        for (size_t j = 0; j < r.size(); ++j) {
            if (!r[j].allFinite()) r[j].setZero();
            solver.r[j].template head<3>() = r[j].head<3>() / system.unit(j);
            if constexpr (D == 4) {
                solver.r[j][3] = spin_unit(j) > 0 ? r[j][3] / (spin_unit(j) * system.unit(j)) : 0;
            }
        }
        solve_system(kind, polygon, system, solver, stats, detail);
        for (size_t j = 0; j < r.size(); ++j) {
            r[j].setZero();
            r[j].head<3>() = solver.r[j].template head<3>() * system.unit(j);
            if constexpr (D == 4) r[j][3] = solver.r[j][3] * spin_unit(j) * system.unit(j);
        }
        system.body_velocity(solver.r);
        return true;
    }
};

}  // namespace

struct ContactSolvers::Memory {
    BodyMemory<3> plain;
    BodyMemory<4> torsional;
    bool torsion = false;       // memory for it is reserved
    bool last_torsion = false;  // the last solve had it
};

ContactSolvers::ContactSolvers() : memory_(std::make_unique<Memory>()) {}
ContactSolvers::~ContactSolvers() = default;
ContactSolvers::ContactSolvers(ContactSolvers&&) noexcept = default;
ContactSolvers& ContactSolvers::operator=(ContactSolvers&&) noexcept = default;

void ContactSolvers::reserve(int bodies, int contacts, bool torsion) {
    memory_->plain.reserve(bodies, contacts);
    memory_->torsion = torsion;
    if (torsion) memory_->torsional.reserve(bodies, contacts);
}

bool ContactSolvers::solve(Solver solver, const PolygonSettings& polygon,
                           const ContactProblem& problem, std::span<Impulse> r, SolveStats& stats,
                           SolveDetail* detail) noexcept {
    stats = {};
    memory_->last_torsion = memory_->torsion && problem.has_torsion();
    return memory_->last_torsion
               ? memory_->torsional.solve(solver, polygon, problem, r, stats, detail)
               : memory_->plain.solve(solver, polygon, problem, r, stats, detail);
}

Eigen::Matrix<double, 6, 1> ContactSolvers::velocity_change(int body) const noexcept {
    return memory_->last_torsion ? memory_->torsional.system.change(body)
                                 : memory_->plain.system.change(body);
}

Eigen::VectorXd solve(Solver solver, const PolygonSettings& polygon, const DelassusProblem& problem,
                      SolveStats& stats, SolveDetail* detail) {
    DelassusSystem system;
    system.assemble(problem);
    SolverMemory<DelassusSystem> memory;
    memory.reserve(system.size(), std::min<size_t>(system.size(), ContactSolvers::kLemkeContacts));
    memory.r.assign(system.size(), Vec3::Zero());
    stats = {};
    if (!problem.W.allFinite() || !problem.q.allFinite() || !problem.mu.allFinite()) {
        stats.missed = stats.refused = true;
        return Eigen::VectorXd::Zero(problem.q.size());
    }
    solve_system(solver, polygon, system, memory, stats, detail);
    Eigen::VectorXd out(problem.q.size());
    for (size_t j = 0; j < system.size(); ++j)
        out.segment<3>(3 * static_cast<Eigen::Index>(j)) = memory.r[j] * system.unit(j);
    return out;
}

}  // namespace dihaptic::contact
