#include "contact/solver.h"

#include <cassert>

#include "contact/body_system.h"
#include "contact/delassus_system.h"
#include "contact/hand_over.h"
#include "contact/newton/newton.h"
#include "contact/sequential_impulse/sequential_impulse.h"
#include "contact/staggered_projections/staggered_projections.h"
#include "contact/stewart_trinkle/stewart_trinkle.h"

namespace dihaptic::contact {
namespace {

constexpr int kMostStaggeredIterations = 200;
constexpr size_t kFewPairs = 10;
/// A problem with at most kFewContacts contacts that is not solved within its bound is allowed
/// kMoreForFew times as much work, unless the tick has already done more than kLittleWork: this
/// happens once in several hundred thousand solves for an object that a finger is about to touch,
/// and often for the parts of a stirred heap.
constexpr size_t kFewContacts = 12;
constexpr int kMoreForFew = 15;
constexpr int64_t kLittleWork = 20'000;  // [visits], about half a millisecond
constexpr size_t kExactWhenBounded = 2;  // number of methods from hand_over() that count as exact
                                         // when work is bounded
constexpr double kSharp = 1e-2;          // share of the tolerance for which a sharpened answer aims
/// With these starts, loads that the equations leave undetermined keep their shares, since rho is
/// large at first and falls slowly.
constexpr std::array kSharpeningStarts{
    NewtonStart{NewtonStart::From::given, 1e-2, 40, 6, 12, false, 0, 0},
    NewtonStart{NewtonStart::From::best, 1e-3, 40, 6, 12, true, 0, 0}, kNewtonStarts[2]};
constexpr std::span<const NewtonStart> kSharpenGently = std::span(kSharpeningStarts).first(2);
constexpr std::span<const NewtonStart> kSharpenAtLast = std::span(kSharpeningStarts).last(1);
/// Bound on staggered projections that another solver hands over to: on pairs times squared
/// contacts.
constexpr size_t kMostStaggeredWork = 20'000;

/// A path along which friction changes in equal steps from a multiple of its value to its value.
struct FrictionPath {
    double from;
    int steps;
};
/// Without friction, a problem is convex. Of problems that newton's starts miss, each path answers
/// about half, short ones at least cost; all of them together answer four of five (ADR 37).
constexpr std::array<FrictionPath, 9> kFrictionPaths{
    {{0, 5}, {0, 20}, {2, 5}, {2, 20}, {0, 50}, {2, 50}, {0, 100}, {4, 50}, {0, 200}}};

template <class System>
struct SolverMemory {
    StaggeredMemory<System> staggered;  // its Newton part is used by all methods
    StewartTrinkleMemory<System> stewart_trinkle;
    std::vector<typename System::Vec> r;
    std::vector<typename System::Vec> before;  // impulses before a continuation
    std::vector<double> friction;              // of each contact

    void reserve(size_t contacts, size_t lemke_contacts) {
        staggered.reserve(contacts);
        stewart_trinkle.reserve(contacts, lemke_contacts);
        r.reserve(contacts);
        before.reserve(contacts);
        friction.reserve(contacts);
    }
};

/// One solve: tries the requested solver, then others until one succeeds. Leaves the answer in
/// memory.r.
template <class System>
class Solve {
  public:
    using Vec = typename System::Vec;

    Solve(System& system, SolverMemory<System>& memory, SolveStats& stats)
        : system_(system),
          memory_(memory),
          newton_memory_(memory.staggered.newton),
          r_(memory.r),
          size_(load(system)),
          contacts_(std::max<size_t>(r_.size(), 1)),
          stats_(stats) {
        newton_memory_.resize(r_.size());
    }

    void run(Solver solver, SolveSettings settings, SolveDetail* detail) {
        Work alone;
        Work& work = settings.tick != nullptr ? *settings.tick : alone;
        const int64_t before = work.spent();
        system_.count_in(work);
        work.begin_exact();
        work.spend(visits(Visits::assembly));
        answer(solver, settings, detail);
        stats_.work = work.spent() - before;
    }

  private:
    void answer(Solver solver, SolveSettings settings, SolveDetail* detail) {
        project();
        const bool sweeps = solver == Solver::sequential_impulse;
        if (sweeps) settings.work = kUnbounded;  // sweeps have their own bounds
        const bool bounded = settings.work < kUnbounded;
        out_of_work_ = !sweeps && !system_.work().affords(visits(kFewestSteps * kVisitsPerStep));
        const bool exact =
            !sweeps && !out_of_work_ && affords(kFewestSteps, settings) && system_.prepare_newton();
        const std::array routes = hand_over(solver, exact, bounded);
        if (exact && bounded) try_if_few(routes, settings, detail);
        hand_on(routes, exact, settings, detail);
        if (out_of_work_) stats_.route = Route::out_of_work;
        stats_.ended = out_of_work_ || (bounded && stats_.route == Route::sequential_impulse);
        if (!exact) stats_.fallback = !sweeps;
        const Residual residual = end_inside_cone(exact);
        stats_.residual = residual.given;
        // the answer of Stewart and Trinkle's method solves a problem other than Coulomb's
        const bool own = solver == Solver::stewart_trinkle && !stats_.fallback;
        stats_.missed = !own && !(residual.judged() <= kTolerance);
    }

    /// If there are few contacts, tries the exact methods and then allows more work for a second
    /// attempt.
    void try_if_few(std::span<const Route> routes, SolveSettings& settings, SolveDetail* detail) {
        if (contacts_ > kFewContacts) return;
        hand_on(routes.first(kExactWhenBounded), true, settings, detail);
        if (system_.work().spent() < kLittleWork) settings.work *= kMoreForFew;
    }

    /// Tries one method after another; if the tick's work budget runs out, finishes the solve with
    /// sweeps.
    void hand_on(std::span<const Route> routes, bool exact, const SolveSettings& settings,
                 SolveDetail* detail) {
        for (const Route route : routes) {
            if (route == Route::none || outcome_.converged) return;
            if (exact && !may_step()) break;
            ask(route, first_, settings, detail);
            if (first_ && exact) stats_.fallback = !outcome_.converged;
            first_ = false;
        }
        if (outcome_.converged || may_step()) return;
        stats_.fallback = out_of_work_ = true;
        ask(Route::sequential_impulse, false, settings, detail);
    }

    /// Whether the tick's work budget allows another pair of steps. All methods except sweeps
    /// consist of such pairs.
    bool may_step() const { return system_.work().affords(2 * system_.step_visits()); }

    int64_t visits(int64_t of_each) const { return of_each * static_cast<int64_t>(r_.size()); }

    /// Whether the work budget suffices for this many Newton steps.
    bool affords(int steps, const SolveSettings& settings) const {
        return static_cast<size_t>(settings.work) >= contacts_ * kVisitsPerStep * steps;
    }

    void ask(Route route, bool first, const SolveSettings& settings, SolveDetail* detail) {
        stats_.route = route;
        // newton, which answers nearly everything, is useless with no work left to do it with
        const bool hands_on = first && route != Route::newton && route != Route::sequential_impulse;
        if (hands_on) system_.work().begin_half();
        outcome_ = by(route, first, settings, detail);
        if (hands_on) system_.work().begin_exact();
        stats_.iterations += outcome_.iterations;
        const int of_each = route == Route::sequential_impulse ? kVisitsPerSweep : kVisitsPerStep;
        counted_ += static_cast<int>(r_.size()) * of_each * outcome_.iterations;
        if (first && outcome_.iterations == 0)
            stats_.route = r_.empty() ? Route::none : Route::start;
    }

    Outcome by(Route route, bool first, const SolveSettings& settings, SolveDetail* detail) {
        switch (route) {
            case Route::own_newton:
                return by_stewart_trinkle(settings.polygon, detail);
            case Route::staggered_projections:
                return by_staggered_projections(first);
            case Route::continuation:
                return by_continuation();
            case Route::sequential_impulse:
                return by_sweeps_alone(settings);
            default:
                return by_newton(kNewtonStarts,
                                 static_cast<size_t>(settings.work) / kVisitsPerStep);
        }
    }

    Outcome by_stewart_trinkle(const PolygonSettings& polygon, SolveDetail* detail) {
        StewartTrinkle<System> method(system_, polygon, kTolerance, memory_.stewart_trinkle);
        const StewartTrinkleOutcome answer = method.solve(r_);
        stats_.route = answer.route;
        if (detail != nullptr) *detail = {answer.lcp_residual};
        return answer;
    }

    /// Tries staggered projections, with few pairs if another solver was requested.
    Outcome by_staggered_projections(bool asked) {
        const size_t few = std::min(kFewPairs, kMostStaggeredWork / (contacts_ * contacts_));
        return staggered_projections(system_, r_, kTolerance,
                                     asked ? kMostStaggeredIterations : static_cast<int>(few),
                                     memory_.staggered);
    }

    Outcome by_sweeps_alone(const SolveSettings& settings) {
        const int left = std::max(0, settings.work - counted_);
        const int affordable = left / (kVisitsPerSweep * static_cast<int>(contacts_));
        const int most = std::max(affordable, kFewestSweeps);
        system_.work().begin_sweeps(visits(kFewestSweeps * kVisitsPerSweep));
        const Outcome outcome = sequential_impulse(system_, r_, settings.sweeps, most);
        const bool cut = outcome.iterations < std::min(most, settings.sweeps.most) &&
                         !system_.work().affords(visits(kVisitsPerSweep));
        out_of_work_ = out_of_work_ || cut;
        return outcome;
    }

    Outcome by_newton(std::span<const NewtonStart> starts = kNewtonStarts,
                      size_t most_work = kMostNewtonWork) {
        return newton(system_, r_, kTolerance, kTolerance, newton_memory_, starts,
                      std::min(most_work, kMostNewtonWork));
    }

    /// Follows the answer of an easier problem as friction changes to its value: without friction,
    /// the problem is convex. Tries one path after another.
    Outcome by_continuation() {
        std::vector<Vec>& before = memory_.before;
        before.assign(r_.begin(), r_.end());
        memory_.friction.clear();
        for (size_t j = 0; j < r_.size(); ++j) memory_.friction.push_back(system_.scale(j).mu);
        Outcome out;
        for (const FrictionPath& path : kFrictionPaths) {
            if (!may_step() || follow(path, out)) break;
        }
        scale_friction(1);
        if (!out.converged) std::copy(before.begin(), before.end(), r_.begin());
        return out;
    }

    /// Returns whether the path led to an answer.
    bool follow(const FrictionPath& path, Outcome& out) {
        constexpr std::array kStarts{kNewtonStarts[0], kNewtonStarts[2]};
        for (Vec& impulse : r_) impulse.setZero();
        for (int step = 0; step <= path.steps; ++step) {
            scale_friction(path.from + (1 - path.from) * step / path.steps);
            const Outcome at = by_newton(kStarts);
            out.iterations += at.iterations;
            if (!at.converged) return false;
            out.residual = at.residual;
        }
        return out.converged = true;
    }

    void scale_friction(double share) {
        for (size_t j = 0; j < r_.size(); ++j) system_.set_friction(j, share * memory_.friction[j]);
    }

    /// Projects the impulses into the cone, so that a remaining error never pulls bodies together.
    /// Some problems are so delicate that even this small change is too much. Their answers are
    /// sharpened first: a few more steps of Newton's method leave nearly nothing to project, and a
    /// cautious start is used for the few answers that they cannot improve. An answer that is still
    /// outside is left as it is. `exact`: whether Newton's matrix has been prepared.
    Residual end_inside_cone(bool exact) {
        // sweeps end inside the cone, except for rounding
        if (stats_.route == Route::sequential_impulse || stats_.route == Route::out_of_work) {
            project();
            return cone_residual();
        }
        Residual unprojected;
        const Residual projected = project_or_restore(unprojected);
        if (projected.judged() <= kTolerance) return projected;
        if (unprojected.judged() > kTolerance) {
            project();
            return cone_residual();
        }
        if (!exact) return unprojected;
        for (const std::span<const NewtonStart> starts : {kSharpenGently, kSharpenAtLast}) {
            sharpen(starts);
            const Residual sharp = project_or_restore(unprojected);
            if (sharp.judged() <= kTolerance) return sharp;
        }
        return unprojected;
    }

    /// Projects the impulses and returns their residual. If that misses the tolerance, restores the
    /// impulses as they were, whose residual is then stored in `unprojected`.
    Residual project_or_restore(Residual& unprojected) {
        std::copy(r_.begin(), r_.end(), newton_memory_.best.begin());
        project();
        const Residual projected = cone_residual();
        if (projected.judged() <= kTolerance) return projected;
        std::copy(newton_memory_.best.begin(), newton_memory_.best.end(), r_.begin());
        unprojected = cone_residual();
        return projected;
    }

    /// Takes further steps of Newton's method, far below the tolerance.
    void sharpen(std::span<const NewtonStart> starts) {
        stats_.iterations +=
            newton(system_, r_, kSharp * kTolerance, kTolerance, newton_memory_, starts).iterations;
    }

    void project() {
        for (size_t j = 0; j < r_.size(); ++j)
            law::project<System::D>(law::Coulomb{}, system_.scale(j), r_[j], j);
    }

    Residual cone_residual() {
        system_.velocity(r_, newton_memory_.u);
        return coulomb_residual(system_, std::span<const Vec>(r_),
                                std::span<const Vec>(newton_memory_.u), size_, kTolerance);
    }

    System& system_;
    SolverMemory<System>& memory_;
    NewtonMemory<System>& newton_memory_;
    std::span<Vec> r_;
    Load size_;
    size_t contacts_;  // number of contacts, at least 1
    SolveStats& stats_;
    Outcome outcome_;
    bool first_ = true;         // whether no method has been tried yet
    int counted_ = 0;           // visits that count towards the work limit
    bool out_of_work_ = false;  // whether the tick's work budget is used up
};

template <int D>
struct BodyMemory {
    BodySystem<D> system;
    SolverMemory<BodySystem<D>> solver;

    void reserve(int bodies, int contacts, int joints) {
        system.reserve(bodies, contacts, joints);
        solver.reserve(static_cast<size_t>(contacts) + static_cast<size_t>(joints),
                       static_cast<size_t>(std::min(contacts, ContactSolvers::kLemkeContacts)));
    }

    void solve(Solver kind, const SolveSettings& settings, const ContactProblem& problem,
               std::span<Impulse> r, std::span<Vec3> joints, SolveStats& stats,
               SolveDetail* detail) {
        system.assemble(problem);
        solver.r.resize(r.size() + joints.size());
        if (!system.is_finite()) {
            for (Impulse& impulse : r) impulse.setZero();
            for (Vec3& impulse : joints) impulse.setZero();
            for (auto& impulse : solver.r) impulse.setZero();
            system.body_velocity(solver.r);
            stats.missed = stats.refused = true;
            return;
        }
        const auto spin_unit = [&](size_t j) { return problem.contacts[j].torsion_radius; };
        for (size_t j = 0; j < r.size(); ++j) {
            if (!r[j].allFinite()) r[j].setZero();
            solver.r[j].template head<3>() = r[j].head<3>() / system.unit(j);
            if constexpr (D == 4) {
                solver.r[j][3] = spin_unit(j) > 0 ? r[j][3] / (spin_unit(j) * system.unit(j)) : 0;
            }
        }
        for (size_t j = 0; j < joints.size(); ++j) {
            auto& start = solver.r[r.size() + j];
            start.setZero();
            if (joints[j].allFinite())
                start.template head<3>() = joints[j] / system.unit(r.size() + j);
        }
        Solve<BodySystem<D>>(system, solver, stats).run(kind, settings, detail);
        for (size_t j = 0; j < joints.size(); ++j)
            joints[j] = solver.r[r.size() + j].template head<3>() * system.unit(r.size() + j);
        for (size_t j = 0; j < r.size(); ++j) {
            r[j].setZero();
            r[j].head<3>() = solver.r[j].template head<3>() * system.unit(j);
            if constexpr (D == 4) r[j][3] = solver.r[j][3] * spin_unit(j) * system.unit(j);
        }
        system.body_velocity(solver.r);
    }
};

}  // namespace

struct ContactSolvers::Memory {
    BodyMemory<3> plain;
    BodyMemory<4> torsional;
    bool torsion = false;       // whether memory is reserved for torsion
    bool last_torsion = false;  // whether the last solve included torsion
};

ContactSolvers::ContactSolvers() : memory_(std::make_unique<Memory>()) {}
ContactSolvers::~ContactSolvers() = default;
ContactSolvers::ContactSolvers(ContactSolvers&&) noexcept = default;
ContactSolvers& ContactSolvers::operator=(ContactSolvers&&) noexcept = default;

void ContactSolvers::reserve(int bodies, int contacts, bool torsion, int joints) {
    memory_->plain.reserve(bodies, contacts, joints);
    memory_->torsion = torsion;
    if (torsion) memory_->torsional.reserve(bodies, contacts, joints);
}

void ContactSolvers::solve(Solver solver, const SolveSettings& settings,
                           const ContactProblem& problem, std::span<Impulse> r,
                           std::span<Vec3> joints, SolveStats& stats,
                           SolveDetail* detail) noexcept {
    assert(r.size() == problem.contacts.size() && joints.size() == problem.joints.size());
    stats = {};
    memory_->last_torsion = memory_->torsion && problem.has_torsion();
    if (memory_->last_torsion) {
        memory_->torsional.solve(solver, settings, problem, r, joints, stats, detail);
    } else {
        memory_->plain.solve(solver, settings, problem, r, joints, stats, detail);
    }
}

Vec6 ContactSolvers::velocity_change(int body) const noexcept {
    return memory_->last_torsion ? memory_->torsional.system.change(body)
                                 : memory_->plain.system.change(body);
}

Eigen::VectorXd solve(Solver solver, const SolveSettings& settings, const DelassusProblem& problem,
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
    Solve<DelassusSystem>(system, memory, stats).run(solver, settings, detail);
    Eigen::VectorXd out(problem.q.size());
    for (size_t j = 0; j < system.size(); ++j)
        out.segment<3>(3 * static_cast<Eigen::Index>(j)) = memory.r[j] * system.unit(j);
    return out;
}

}  // namespace dihaptic::contact
