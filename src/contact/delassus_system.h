// DelassusSystem is the contact problem in contact space, scaled as BodySystem scales it, with W as
// a dense matrix: for problems that are given without bodies. Allocates.
#pragma once

#include <span>
#include <vector>

#include "contact/law.h"

namespace dihaptic::contact {

class DelassusSystem {
  public:
    static constexpr int D = 3;
    using Vec = Eigen::Vector3d;

    void assemble(const DelassusProblem& problem);

    size_t size() const noexcept { return scales_.size(); }
    const Scale& scale(size_t j) const noexcept { return scales_[j]; }
    Vec q(size_t j) const noexcept { return q_.segment<3>(3 * static_cast<Eigen::Index>(j)); }
    double unit(size_t j) const noexcept { return units_[j]; }

    void velocity(std::span<const Vec> r, std::span<Vec> u) noexcept;
    void newton_step(std::span<const Linearised<3>> contacts, std::span<Vec> d);
    /// Projected Gauss-Seidel sweeps on a law.
    template <class Law>
    void sweep(const Law& law, std::span<Vec> r, int sweeps) noexcept {
        const Eigen::Map<const Eigen::VectorXd> all(r.data()->data(), q_.size());
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            for (size_t j = 0; j < size(); ++j) {
                const auto row = 3 * static_cast<Eigen::Index>(j);
                const Vec u = W_.middleRows<3>(row) * all + q_.segment<3>(row);
                law.template relax<3>(scales_[j], r[j], u, j);
            }
        }
    }
    Mat3 delassus_block(size_t j, size_t k) const noexcept {
        return W_.block<3, 3>(3 * static_cast<Eigen::Index>(j), 3 * static_cast<Eigen::Index>(k));
    }

  private:
    Eigen::MatrixXd W_;
    Eigen::VectorXd q_;
    std::vector<Scale> scales_;
    std::vector<double> units_;
};

}  // namespace dihaptic::contact
