// DelassusSystem represents the contact problem in contact space, scaled as in BodySystem, with a
// dense matrix W. It is used for problems that are given without bodies. It allocates memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "contact/law.h"
#include "contact/work.h"

namespace dihaptic::contact {

class DelassusSystem {
  public:
    static constexpr int D = 3;
    using Vec = Eigen::Vector3d;

    void assemble(const DelassusProblem& problem);

    size_t size() const noexcept { return scales_.size(); }
    const Scale& scale(size_t j) const noexcept { return scales_[j]; }
    void set_friction(size_t j, double mu) noexcept { scales_[j].mu = mu; }
    Vec q(size_t j) const noexcept { return q_.segment<3>(3 * static_cast<Eigen::Index>(j)); }
    double unit(size_t j) const noexcept { return units_[j]; }

    /// Work is counted as in BodySystem. The exact amount does not matter, since these problems are
    /// solved outside ticks.
    void count_in(Work& work) noexcept { work_ = &work; }
    Work& work() const noexcept { return *work_; }
    int64_t step_visits() const noexcept { return Visits::matrix * static_cast<int64_t>(size()); }

    void velocity(std::span<const Vec> r, std::span<Vec> u) noexcept;
    void newton_step(std::span<const Linearised<3>> contacts, std::span<Vec> d);
    static bool prepare_newton() noexcept { return true; }
    static bool has_joints() noexcept { return false; }
    /// Like BodySystem::sweep().
    template <class Law>
    int sweep(const Law& law, std::span<Vec> r, int most, double enough = -1) noexcept {
        const int64_t visits = Law::kVisits * static_cast<int64_t>(size());
        for (int sweep = 1; sweep <= most; ++sweep) {
            if (!work_->affords(visits)) return sweep - 1;
            work_->spend(visits);
            if (pass(law, r) <= enough * std::abs(enough)) return sweep;
        }
        return most;
    }
    Mat3 delassus_block(size_t j, size_t k) const noexcept {
        return W_.block<3, 3>(3 * static_cast<Eigen::Index>(j), 3 * static_cast<Eigen::Index>(k));
    }

  private:
    template <class Law>
    double pass(const Law& law, std::span<Vec> r) noexcept {
        const Eigen::Map<const Eigen::VectorXd> all(r.data()->data(), q_.size());
        double most = 0;
        for (size_t j = 0; j < size(); ++j) {
            const auto row = 3 * static_cast<Eigen::Index>(j);
            const Vec u = W_.middleRows<3>(row) * all + q_.segment<3>(row);
            const Vec before = r[j];
            law.template relax<3>(scales_[j], r[j], u, j);
            most = std::max(most, (r[j] - before).squaredNorm() / (units_[j] * units_[j]));
        }
        return most;
    }
    double pass(const law::NormalThenFriction& law, std::span<Vec> r) noexcept {
        const double change = pass(law.normal, r);
        return std::max(change, pass(law.friction, r));
    }

    Eigen::MatrixXd W_;
    Eigen::VectorXd q_;
    std::vector<Scale> scales_;
    std::vector<double> units_;
    Work* work_ = nullptr;
};

}  // namespace dihaptic::contact
