// Staggered projections (Kaufman, Sueda, James and Pai 2008) solve Coulomb's law as two
// alternating convex problems,
//
//     friction:  the tangential impulses that dissipate most, on discs of radius mu r_N
//     contact:   the normal impulses that keep bodies apart, with that friction
//
// which are repeated until they agree. Each problem is solved exactly by the proximal Newton
// method, which finds the active set of a convex problem; inexact inner solutions would stall the
// outer loop at their own error. Contacts without load are left out of the friction problem.
// Anderson acceleration of the normal impulses shortens the loop; if the loop still wanders,
// projected Gauss-Seidel sweeps provide new iterates. Every pair ends with a contact projection, so
// no pair leaves bodies approaching each other; the best pair is the answer.
#pragma once

#include "contact/anderson.h"
#include "contact/newton/newton.h"

namespace dihaptic::contact {

template <class System>
struct StaggeredMemory {
    NewtonMemory<System> newton;
    Anderson anderson;
    std::vector<typename System::Vec> best;
    std::vector<double> normal;  ///< the loads given to the friction problem
    std::vector<double> image;   ///< the loads that result from the contact problem

    void reserve(size_t contacts) {
        newton.reserve(contacts);
        anderson.reserve(contacts);
        best.reserve(contacts);
        normal.reserve(contacts);
        image.reserve(contacts);
    }
};

/// The working state for staggered_projections().
template <class System>
class StaggeredProjections {
  public:
    using Vec = typename System::Vec;

    StaggeredProjections(System& system, std::span<Vec> r, double tolerance,
                         StaggeredMemory<System>& memory)
        : system_(system), r_(r), tolerance_(tolerance), memory_(memory), size_(load(system)) {
        memory.best.resize(r.size());
        memory.normal.resize(r.size());
        memory.image.resize(r.size());
        memory.anderson.start(r.size());
        memory.newton.resize(r.size());
    }

    Outcome solve(int most_iterations) {
        system_.velocity(r_, memory_.newton.u);
        std::copy(r_.begin(), r_.end(), memory_.best.begin());
        judge();
        for (size_t j = 0; j < r_.size(); ++j) memory_.normal[j] = std::max(0.0, load_of(j));
        if (out_.residual > kTarget * tolerance_) {
            solve_for(law::NormalOnly{});  // first guess of the loads, with the start's friction
            for (size_t j = 0; j < r_.size(); ++j) memory_.normal[j] = load_of(j);
        }
        while (out_.residual > kTarget * tolerance_ && out_.iterations < most_iterations &&
               system_.work().affords(2 * system_.step_visits())) {
            ++out_.iterations;
            solve_pair();
            const double residual = judge();
            if (residual <= kTarget * tolerance_ || is_stalled(residual)) break;
            if (residual > 2 * last_) memory_.anderson.forget();
            last_ = residual;
            if (out_.iterations % kPatience == 0) {
                sweep_on();
            } else {
                accelerate();
            }
        }
        std::copy(memory_.best.begin(), memory_.best.end(), r_.begin());
        system_.velocity(r_, memory_.newton.u);
        return out_;
    }

  private:
    // Tolerance of the inner loop relative to |q|. The inner loop aims for the fraction kTarget of
    // it, and need not be much more exact than the outer loop is at that stage.
    static constexpr double kInnerTolerance = 1e-10;
    static constexpr double kInnerOfLast = 1e-3;
    // Undetermined loads must not wander from one pair to the next: a large rho that falls slowly
    // keeps the inner answer near its start.
    static constexpr NewtonStart kInnerStart[] = {
        {NewtonStart::From::given, 1e-3, 40, 6, 12, false, 0, 0}};
    static constexpr int kPlainIterations = 3;
    static constexpr int kPatience = 15;  // iterations before sweeps provide a new iterate
    static constexpr int kSweeps = 200;

    /// The load of a contact. Returns 0 for a joint, whose rows are solved in both problems.
    double load_of(size_t j) const { return system_.scale(j).joint != nullptr ? 0 : r_[j][0]; }

    /// Solves one of the two convex problems exactly.
    template <class Law>
    void solve_for(const Law& law) {
        const double enough = std::isfinite(last_) ? kInnerOfLast * last_ : 0;
        proximal_newton(
            system_, law, r_, std::max(kInnerTolerance, enough) * size_.scaled, memory_.newton,
            [&](std::span<const Vec> impulse, std::span<const Vec> u) {
                double error = 0;
                for (size_t j = 0; j < impulse.size(); ++j)
                    error += law::residual<System::D>(law, system_.scale(j), impulse[j], u[j], j);
                return std::sqrt(error);
            },
            kInnerStart);
    }

    /// Solves the friction problem for the loads in memory.normal, then the contact problem for
    /// that friction.
    void solve_pair() {
        const law::FrictionOnly friction{memory_.normal};
        for (size_t j = 0; j < r_.size(); ++j) {
            if (system_.scale(j).joint != nullptr) continue;
            r_[j][0] = memory_.normal[j];
            friction.template project<System::D>(system_.scale(j), r_[j], j);
        }
        solve_for(friction);
        solve_for(law::NormalOnly{});
    }

    /// Stores the pair if it is the best so far. Returns its residual.
    double judge() {
        const double residual =
            coulomb_residual(system_, std::span<const Vec>(r_),
                             std::span<const Vec>(memory_.newton.u), size_, tolerance_)
                .judged();
        if (residual < out_.residual) {
            out_.residual = residual;
            std::copy(r_.begin(), r_.end(), memory_.best.begin());
        }
        out_.converged = out_.residual <= tolerance_;
        return residual;
    }

    /// Whether the residual is within tolerance and rounding prevents any further progress.
    bool is_stalled(double residual) {
        return residual <= tolerance_ && residual > kStalledShare * last_ &&
               ++stalled_ >= kStalledIterations;
    }

    void sweep_on() {
        system_.sweep(law::Coulomb{}, r_, kSweeps);
        for (size_t j = 0; j < r_.size(); ++j) memory_.normal[j] = load_of(j);
        memory_.anderson.forget();
        plain_ = kPlainIterations;
    }

    /// Sets the initial loads for the next pair.
    void accelerate() {
        for (size_t j = 0; j < r_.size(); ++j) memory_.image[j] = load_of(j);
        if (plain_ > 0) {
            --plain_;
            // Coulomb's law may have several solutions: small first steps find the nearest one
            memory_.normal.swap(memory_.image);
            return;
        }
        system_.work().spend(Visits::acceleration * static_cast<int64_t>(r_.size()));
        memory_.anderson.advance(memory_.normal, memory_.image);
        for (double& value : memory_.normal) value = std::max(0.0, value);
    }

    System& system_;
    std::span<Vec> r_;
    double tolerance_;
    StaggeredMemory<System>& memory_;
    Load size_;

    Outcome out_;
    double last_ = std::numeric_limits<double>::infinity();  // residual after the last pair
    int stalled_ = 0;
    int plain_ = kPlainIterations;  // number of iterations left without acceleration
};

/// Starts from r; leaves the best pair in r, and the velocity for that pair in memory.newton.u.
template <class System>
Outcome staggered_projections(System& system, std::span<typename System::Vec> r, double tolerance,
                              int most_iterations, StaggeredMemory<System>& memory) {
    return StaggeredProjections<System>(system, r, tolerance, memory).solve(most_iterations);
}

}  // namespace dihaptic::contact
