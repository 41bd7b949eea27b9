#include "contact/delassus_system.h"

namespace dihaptic::contact {
namespace {

using Stacked = Eigen::Map<const Eigen::VectorXd>;

Stacked stacked(std::span<const Vec3> r) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return {r.data()->data(), static_cast<Eigen::Index>(3 * r.size())};
}

}  // namespace

void DelassusSystem::assemble(const DelassusProblem& problem) {
    const Eigen::Index n = problem.mu.size();
    scales_.assign(static_cast<size_t>(n), {});
    units_.assign(static_cast<size_t>(n), 1);
    W_ = problem.W;
    q_ = problem.q;
    for (Eigen::Index j = 0; j < n; ++j) {
        const auto at = static_cast<size_t>(j);
        const Vec3 diagonal = problem.W.diagonal().segment<3>(3 * j);
        const double mean = diagonal.mean();
        units_[at] = mean > 0 ? 1 / std::sqrt(mean) : 1;
        W_.middleRows<3>(3 * j) *= units_[at];
        W_.middleCols<3>(3 * j) *= units_[at];
        q_.segment<3>(3 * j) *= units_[at];
        scales_[at].mu = problem.mu[j];
        if (diagonal[0] > 0) scales_[at].a_n = mean / diagonal[0];
        if (diagonal[1] + diagonal[2] > 0) scales_[at].a_t = 2 * mean / (diagonal[1] + diagonal[2]);
    }
}

void DelassusSystem::velocity(std::span<const Vec> r, std::span<Vec> u) noexcept {
    work_->spend(Visits::velocity * static_cast<int64_t>(size()));
    Eigen::Map<Eigen::VectorXd> out(u.data()->data(), q_.size());
    out = q_;
    out.noalias() += W_ * stacked(r);
}

void DelassusSystem::newton_step(std::span<const Linearised<3>> contacts, std::span<Vec> d) {
    work_->spend(step_visits());
    const Eigen::Index n = q_.size();
    Eigen::MatrixXd A(n, n);
    Eigen::VectorXd b(n);
    for (size_t j = 0; j < size(); ++j) {
        const auto row = 3 * static_cast<Eigen::Index>(j);
        const Linearised<3>& contact = contacts[j];
        auto rows = A.middleRows<3>(row);
        rows.noalias() = contact.G * W_.middleRows<3>(row);
        rows.middleCols<3>(row) += Mat3::Identity();
        b.segment<3>(row) = -contact.c;
        for (Eigen::Index i = row; i < row + 3; ++i) {  // rows differ in size like 1/rho and 1
            const double by = 1 / A.row(i).lpNorm<Eigen::Infinity>();
            A.row(i) *= by;
            b[i] *= by;
        }
    }
    const Eigen::VectorXd x = A.partialPivLu().solve(b);
    for (size_t j = 0; j < size(); ++j) d[j] = x.segment<3>(3 * static_cast<Eigen::Index>(j));
}

}  // namespace dihaptic::contact
