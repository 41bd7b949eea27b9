// Semismooth Newton's method applied to a contact law (law.h), inside a proximal loop: each
// proximal step makes a singular problem regular, and at convergence (r = r_k) the regularisation
// has no effect on the answer.
//
// At first, full steps are taken, the regularisation follows the residual, and a proximal step ends
// when its equation's error has fallen to a fifth. A proximal step that does not converge is
// undone, a few projected Gauss-Seidel sweeps provide a new iterate, and the regularisation grows
// tenfold. If this takes too long, the method restarts from a different point.
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
    double residual = std::numeric_limits<double>::infinity();  ///< measured like the tolerance
    bool converged = false;
};

/// Relative residual of a contact law (the norm of its natural map), both in the units of the given
/// problem and in those of the scaled system, which do not depend on the choice of units.
struct Residual {
    double scaled = std::numeric_limits<double>::infinity();  ///< over |q^|
    double given = std::numeric_limits<double>::infinity();   ///< divided by 1 + |q|

    /// The value that is compared with tolerances: the given problem's residual or, if larger, a
    /// hundredth of the scaled one, so that small units do not make the test easier. The whole
    /// scaled value would be too strict: with very small loads, the rounding in the gaps of four
    /// coplanar contacts may contribute more.
    double judged() const noexcept { return std::max(given, 0.01 * scaled); }
};

/// The reference quantities that make residuals relative.
struct Load {
    double scaled = 0;  ///< |q^|
    double given = 0;   ///< |q|

    /// Returns the relative residual, given the squared norms.
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

/// Iterations aim for this fraction of the tolerance, so that answers that barely meet the
/// tolerance are rare.
constexpr double kTarget = 1e-2;
/// Once within tolerance, iterations end when the last kStalledIterations have failed to reduce the
/// best residual to the fraction kStalledShare: rounding then prevents further progress.
constexpr double kStalledShare = 0.5;
constexpr int kStalledIterations = 2;

/// Parameters of one start of the proximal loop.
struct NewtonStart {
    enum class From { given, zero, best, scattered } from;
    double rho;
    int most_steps;
    int trial_steps;  ///< a proximal step is abandoned after this many steps if its error has grown
    int most_inner;   ///< a proximal step is abandoned after this many steps if its error is large
    /// Whether the next rho is proportional to the residual, as in Levenberg and Marquardt's
    /// method; otherwise rho is divided by ten after each proximal step that took few Newton steps.
    bool rho_follows;
    int halvings;  ///< largest number of halvings for a step that makes the error grow fourfold
    int sweeps;    ///< number of initial sweeps, which identify most of the sliding contacts
    /// Number of proximal steps for which rho stays ten times as large as a value that failed. If
    /// 0, rho may return to that value at once and fail again. A jammed object with undetermined
    /// loads needs many proximal steps, each of which is easy while rho is large enough.
    int caution = 0;
};
/// The starts: two quick ones, then four with caution, which solve 99 of 100 problems that the
/// quick ones cannot. The parameters were tuned on bodies thrown together with a different seed
/// from those of the soak tests; results hardly depend on them between 6 and 20 steps before a
/// proximal step is abandoned, and between 10 and 40 for caution.
constexpr auto kNewtonStarts = [] {
    using From = NewtonStart::From;
    return std::array<NewtonStart, 6>{{
        {From::given, 1e-3, 40, 6, 12, true, 0, 2},
        {From::zero, 1e-2, 60, 15, 30, true, 4, 0},
        {From::best, 1e-3, 600, 12, 24, true, 0, 2, 10},
        {From::zero, 1e-1, 600, 20, 40, true, 0, 2, 10},
        {From::scattered, 1e-2, 600, 12, 24, true, 0, 2, 10},
        {From::scattered, 1e-3, 600, 12, 24, true, 0, 2, 10},
    }};
}();

/// Upper limit on contacts times steps, summed over all starts, so that a jammed heap cannot delay
/// the tick for long.
constexpr size_t kMostNewtonWork = 32000;

/// The working state of proximal_newton(): r is the current point, and memory.r_k is the point
/// where the proximal step started.
template <class System, class Law, class Measure>
class ProximalNewton {
  public:
    using Vec = typename System::Vec;

    ProximalNewton(System& system, const Law& law, std::span<Vec> r, double tolerance,
                   NewtonMemory<System>& memory, const Measure& measure, size_t most_work)
        : system_(system),
          law_(law),
          r_(r),
          tolerance_(tolerance),
          memory_(memory),
          measure_(measure),
          most_iterations_(static_cast<int>(most_work / std::max<size_t>(system.size(), 1))) {
        memory.resize(system.size());
    }

    Outcome solve(std::span<const NewtonStart> starts) {
        std::copy(r_.begin(), r_.end(), memory_.best.begin());
        judge();
        for (const NewtonStart& start : starts) {
            if (out_.converged || !may_step() || begin(start)) break;
            take_steps(start);
            out_.converged = out_.converged || out_.residual <= kSafe * tolerance_;
        }
        out_.converged = out_.converged || out_.residual <= tolerance_;
        if (!is_best_) {
            std::copy(memory_.best.begin(), memory_.best.end(), r_.begin());
            system_.velocity(r_, memory_.u);
        }
        return out_;
    }

  private:
    static constexpr double kSafe = 0.1;  // a later start ends at this fraction of the tolerance
    static constexpr double kLeastRho = 1e-7;
    static constexpr double kMostRho = 1.0;
    static constexpr double kRhoOfResidual = 0.3;
    static constexpr double kReduced = 0.05;  // applies to the squared error
    static constexpr double kReducedMuch = 1e-4;
    static constexpr double kGrown = 4;
    static constexpr int kFewSteps = 4;
    static constexpr int kRescueSweeps = 5;
    static constexpr double kScatter = 0.3;  // of |q|

    /// Whether the limits on iterations and work allow another step.
    bool may_step() const {
        return out_.iterations < most_iterations_ && system_.work().affords(system_.step_visits());
    }

    /// Stores r if it is the best so far. Returns whether it is good enough.
    bool judge() {
        system_.work().spend(Law::kVisits * static_cast<int64_t>(r_.size()));
        system_.velocity(r_, memory_.u);
        residual_ = measure_(std::span<const Vec>(r_), std::span<const Vec>(memory_.u));
        if (out_.residual <= tolerance_ && residual_ > kStalledShare * out_.residual) ++stalled_;
        is_best_ = residual_ < out_.residual;
        if (is_best_) {
            out_.residual = residual_;
            std::copy(r_.begin(), r_.end(), memory_.best.begin());
        }
        out_.converged = out_.residual <= kTarget * tolerance_ || stalled_ >= kStalledIterations;
        return out_.converged;
    }

    /// Sets r to the initial point for a start. Returns whether that point is good enough.
    bool begin(const NewtonStart& start) {
        if (start.from == NewtonStart::From::zero) {
            for (Vec& impulse : r_) impulse.setZero();
        } else if (start.from == NewtonStart::From::best) {
            std::copy(memory_.best.begin(), memory_.best.end(), r_.begin());
        } else if (start.from == NewtonStart::From::scattered) {
            const double size = kScatter * load(system_).scaled;
            for (Vec& impulse : r_) {
                for (double& value : impulse)
                    value = size * (2.0 * static_cast<double>(random_()) / random_.max() - 1);
            }
        }
        if (start.from == NewtonStart::From::given && start.sweeps <= 0) return false;
        system_.sweep(law_, r_, start.sweeps);
        return judge();
    }

    /// Takes Newton steps, one proximal step after another, until r is good enough or no steps are
    /// left.
    void take_steps(const NewtonStart& start) {
        rho_ = start.rho;
        least_rho_ = kLeastRho;
        begin_proximal_step();
        for (int step = 0; step < start.most_steps && may_step(); ++step) {
            system_.newton_step(memory_.linearised, memory_.d);
            ++inner_;
            if (move(1) || shorten(start.halvings)) return;
            if (error_ <= (start.rho_follows ? kReduced : kReducedMuch) * first_) {
                lower_rho(start);
                begin_proximal_step();
            } else if (is_lost(start)) {
                if (undo(start)) return;
                begin_proximal_step();
            }
        }
    }

    void begin_proximal_step() {
        std::copy(r_.begin(), r_.end(), memory_.r_k.begin());
        error_ = first_ = linearise();
        inner_ = 0;
    }

    /// Linearises the law. Returns the squared error in the equation of the proximal step.
    double linearise() {
        double error = 0;
        for (size_t j = 0; j < r_.size(); ++j) {
            error += law::linearise<System::D>(law_, system_.scale(j), r_[j], memory_.u[j],
                                               memory_.r_k[j], rho_, memory_.linearised[j], j);
        }
        return error;
    }

    /// Moves r by a fraction of the Newton step. Returns whether r is good enough.
    bool move(double share) {
        for (size_t j = 0; j < r_.size(); ++j) r_[j] += share * memory_.d[j];
        ++out_.iterations;
        return judge();
    }

    /// Repeatedly halves a step that made the error grow. Returns whether r is good enough.
    bool shorten(int halvings) {
        const double before = error_;
        error_ = linearise();
        double share = 1;
        for (int h = 0; h < halvings && !(error_ <= kGrown * before); ++h) {
            share /= 2;
            if (move(-share)) return true;
            error_ = linearise();
        }
        return false;
    }

    void lower_rho(const NewtonStart& start) {
        if (start.caution > 0 && ++succeeded_ >= start.caution) allow(least_rho_ / 10);
        if (start.rho_follows) {
            rho_ = std::clamp(kRhoOfResidual * residual_, least_rho_, rho_);
        } else if (inner_ <= kFewSteps) {
            rho_ = std::max(rho_ / 10, kLeastRho);
        }
    }

    bool is_lost(const NewtonStart& start) const {
        return inner_ >= start.most_inner ||
               (inner_ >= start.trial_steps && error_ > kGrown * first_) || !std::isfinite(error_);
    }

    /// Undoes the proximal step and continues with sweeps. Returns whether r is good enough.
    bool undo(const NewtonStart& start) {
        std::copy(memory_.r_k.begin(), memory_.r_k.end(), r_.begin());
        system_.sweep(law_, r_, kRescueSweeps);
        rho_ = std::min(rho_ * 10, kMostRho);
        if (start.caution > 0) allow(rho_);
        return judge();
    }

    /// Sets a lower limit for rho that applies until the start's caution ends.
    void allow(double rho) {
        least_rho_ = std::max(rho, kLeastRho);
        succeeded_ = 0;
    }

    System& system_;
    const Law& law_;
    std::span<Vec> r_;
    double tolerance_;
    NewtonMemory<System>& memory_;
    const Measure& measure_;
    int most_iterations_;
    std::minstd_rand random_;  // produces the same numbers in every solve, for replay

    Outcome out_;
    double residual_ = 0;   // residual of r
    bool is_best_ = false;  // whether r is the best so far, and memory.u is its velocity
    int stalled_ = 0;
    double rho_ = 0;
    double least_rho_ = kLeastRho;
    int succeeded_ = 0;  // number of proximal steps since least_rho_ changed
    double first_ = 0;   // squared error at the start of the proximal step
    double error_ = 0;   // current squared error
    int inner_ = 0;      // number of Newton steps in the current proximal step
};

/// Solves `law` for r [scaled], starting from r, until `measure(r, u)` is at most kTarget of
/// `tolerance` or all `starts` are used up. On return, r is the best point found and memory.u is
/// its velocity.
template <class System, class Law, class Measure>
Outcome proximal_newton(System& system, const Law& law, std::span<typename System::Vec> r,
                        double tolerance, NewtonMemory<System>& memory, const Measure& measure,
                        std::span<const NewtonStart> starts = kNewtonStarts,
                        size_t most_work = kMostNewtonWork) {
    return ProximalNewton<System, Law, Measure>(system, law, r, tolerance, memory, measure,
                                                most_work)
        .solve(starts);
}

/// Residual of Coulomb's law. If the residual of the given problem exceeds `enough`, the scaled
/// residual is not computed and is left at zero.
template <class System>
Residual coulomb_residual(const System& system, std::span<const typename System::Vec> r,
                          std::span<const typename System::Vec> u, const Load& load,
                          double enough = std::numeric_limits<double>::infinity()) noexcept {
    using Vec = typename System::Vec;
    double given = 0;
    for (size_t j = 0; j < system.size(); ++j) {
        const double unit = system.unit(j);
        if (const JointScale* joint = system.scale(j).joint; joint != nullptr) {
            given += law::Joint::residual<System::D>(*joint, r[j], u[j], unit);
            continue;
        }
        const Vec r_given = r[j] * unit;
        const Vec u_given = u[j] * (1 / unit);
        given += natural_map_squared<System::D>(r_given, u_given, system.scale(j).mu);
    }
    const Residual far = load.residual(0, given);
    if (far.given > enough) return far;
    double scaled = 0;
    for (size_t j = 0; j < system.size(); ++j)
        scaled += law::residual<System::D>(law::Coulomb{}, system.scale(j), r[j], u[j], j);
    return load.residual(scaled, given);
}

/// Solves Coulomb's law with proximal_newton(). `enough` is that of coulomb_residual(): with a
/// tolerance below it, points that already meet `enough` are still compared by both residuals.
template <class System>
Outcome newton(System& system, std::span<typename System::Vec> r, double tolerance, double enough,
               NewtonMemory<System>& memory, std::span<const NewtonStart> starts = kNewtonStarts,
               size_t most_work = kMostNewtonWork) {
    using Vec = typename System::Vec;
    const Load size = load(system);
    return proximal_newton(
        system, law::Coulomb{}, r, tolerance, memory,
        [&](std::span<const Vec> impulse, std::span<const Vec> u) {
            return coulomb_residual(system, impulse, u, size, enough).judged();
        },
        starts, most_work);
}

}  // namespace dihaptic::contact
