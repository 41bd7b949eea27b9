// BodySystem represents the scaled contact problem in body space: u = H y + q, y = H' r, W = H H'.
// W is never formed; instead, the Newton equation is solved with a matrix in which each body has a
// row (Woodbury):
//
//     (I + G H H') d = -c   <=>   (I + H' G H) y = -H' c,   d = -c - G H y
//
// H contains the inverse square roots of mass and inertia, and each contact's rows are divided by
// the root of the mean diagonal of its block of W. Impulses are then r = scale * r^, velocities u =
// u^ / scale, and nothing depends on the choice of units. Soft contacts add their compliance to the
// diagonal of W.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "contact/block_lu.h"
#include "contact/law.h"
#include "contact/rows.h"
#include "contact/work.h"

namespace dihaptic::contact {

template <int Dim>
class BodySystem {
  public:
    static constexpr int D = Dim;
    using Vec = Eigen::Matrix<double, D, 1>;

    void reserve(int bodies, int contacts, int joints);
    /// Sets up the scaled system. Allocates memory if the problem is larger than reserved.
    void assemble(const ContactProblem& problem) noexcept;
    /// Adds the work of all subsequent calls to `work`.
    void count_in(Work& work) noexcept { work_ = &work; }
    Work& work() const noexcept { return *work_; }
    /// Cost of one step of Newton's method, excluding the contact law [visits].
    int64_t step_visits() const noexcept {
        return Visits::matrix * static_cast<int64_t>(size()) + Visits::product * lu_.products();
    }
    /// Prepares the matrix for newton_step(). Returns false if it is larger than reserved.
    bool prepare_newton() noexcept;

    /// Number of contacts and joints; contacts have the lower indices.
    size_t size() const noexcept { return rows_.size(); }
    bool has_joints() const noexcept { return !joints_.empty(); }
    /// Whether every number in the problem is finite and usable.
    bool is_finite() const noexcept { return finite_; }
    const Scale& scale(size_t j) const noexcept { return rows_[j].law; }
    void set_friction(size_t j, double mu) noexcept { rows_[j].law.mu = mu; }
    const Vec& q(size_t j) const noexcept { return rows_[j].q; }
    /// Factor that converts a scaled impulse into an impulse.
    double unit(size_t j) const noexcept { return rows_[j].unit; }

    /// Computes u = W r + q.
    void velocity(std::span<const Vec> r, std::span<Vec> u) noexcept;
    /// Solves (I + G W) d = -c for d. Overwrites G and c.
    void newton_step(std::span<Linearised<D>> contacts, std::span<Vec> d) noexcept;
    /// Runs projected Gauss-Seidel sweeps on a contact law until a sweep changes no contact's
    /// velocity by more than `enough` [m/s], or until the allowed work is used up. Returns the
    /// number of sweeps.
    template <class Law>
    int sweep(const Law& law, std::span<Vec> r, int most, double enough = -1) noexcept {
        gather(r);
        const int64_t visits = Law::kVisits * static_cast<int64_t>(size());
        for (int sweep = 1; sweep <= most; ++sweep) {
            if (!work_->affords(visits)) return sweep - 1;
            work_->spend(visits);
            if (pass(law, r) <= enough * std::abs(enough)) return sweep;
        }
        return most;
    }
    /// The block of W in the rows of contact j and the columns of contact k.
    Eigen::Matrix<double, Dim, Dim> delassus_block(size_t j, size_t k) const noexcept;

    /// Computes the velocity changes of all bodies due to the impulses r. change() returns the
    /// result for one body: linear velocity, then angular velocity.
    void body_velocity(std::span<const Vec> r) noexcept;
    Vec6 change(int body) const noexcept;

  private:
    /// Runs one sweep. Returns the square of the largest change in a contact's velocity.
    template <class Law>
    double pass(const Law& law, std::span<Vec> r) noexcept {
        double most = 0;
        for (size_t j = 0; j < rows_.size(); ++j) {
            const ContactRows& row = rows_[j];
            const bool is_contact = row.law.joint == nullptr;
            Vec u = row.q;
            if (is_contact) {
                add_velocity<law::touches<Law>()>(row, u);
            } else {
                add_velocity<law::Touches::all>(row, u);
            }
            u[0] += row.compliance * r[j][0];
            const Vec before = r[j];
            law::relax<D>(law, row.law, r[j], u, j);
            const Vec change = r[j] - before;
            if (is_contact) {
                apply<law::touches<Law>()>(row, change);
            } else {
                apply<law::Touches::all>(row, change);
            }
            most = std::max(most, change.squaredNorm() / (row.unit * row.unit));
        }
        return most;
    }
    double pass(const law::NormalThenFriction& law, std::span<Vec> r) noexcept {
        const double change = pass(law.normal, r);
        return std::max(change, pass(law.friction, r));
    }

    /// H is stored transposed, so that a column fills whole SIMD packets.
    using Ht = Eigen::Matrix<double, 6, D>;
    struct ContactRows {
        Ht Ht_a;
        Ht Ht_b;
        Vec q;
        Scale law;
        double unit = 1;
        double compliance = 0;  // of a contact along its normal; for a joint, see `law`
        int a = kFixed;
        int b = kFixed;
        int aa = -1, bb = -1, ab = -1, ba = -1;  // block indices in the body matrix
    };

    void assemble_row(const ContactProblem& problem, const ProblemContact& contact,
                      ContactRows& row) noexcept;
    void assemble_joint(const ContactProblem& problem, const ProblemJoint& joint, ContactRows& row,
                        JointScale& scale) noexcept;
    void find_blocks(ContactRows& row) const noexcept;
    /// Whether the G of a row is the same in every step of Newton's method.
    static bool is_linear(const ContactRows& row) noexcept {
        return row.law.joint != nullptr && row.law.joint->linear;
    }
    /// Adds H' G H of one contact or joint to the body matrix.
    void add_to_matrix(const ContactRows& row, const Linearised<D>& contact) noexcept;
    /// Moves the compliance of soft contacts from W to G and c.
    void soften(std::span<Linearised<D>> contacts) const noexcept;
    void gather(std::span<const Vec> r) noexcept;
    /// Adds H' r of one contact to y. Rows of r that `which` excludes must be zero.
    template <law::Touches which = law::Touches::all>
    void apply(const ContactRows& row, const Vec& r) noexcept {
        const auto add = [&](int body, const Ht& H_t) {
            if (body == kFixed) return;
            Vec6& y = y_[static_cast<size_t>(body)];
            if constexpr (which == law::Touches::normal) {
                y.noalias() += H_t.col(0) * r[0];
            } else if constexpr (which == law::Touches::friction) {
                y.noalias() +=
                    H_t.template rightCols<D - 1>().lazyProduct(r.template tail<D - 1>());
            } else {
                y.noalias() += H_t.lazyProduct(r);
            }
        };
        add(row.a, row.Ht_a);
        add(row.b, row.Ht_b);
    }
    /// Adds H y for one contact to u, or to those rows of u that `which` includes.
    template <law::Touches which = law::Touches::all>
    void add_velocity(const ContactRows& row, Vec& u) const noexcept {
        const auto add = [&](int body, const Ht& H_t) {
            if (body == kFixed) return;
            const Vec6& y = y_[static_cast<size_t>(body)];
            constexpr int first = which == law::Touches::friction ? 1 : 0;
            constexpr int end = which == law::Touches::normal ? 1 : D;
            for (int i = first; i < end; ++i) u[i] += H_t.col(i).dot(y);
        };
        add(row.a, row.Ht_a);
        add(row.b, row.Ht_b);
    }

    std::vector<ContactRows> rows_;
    std::vector<JointScale> joints_;
    std::vector<Mat6> root_;  // for each body, the root of its inverse mass matrix
    std::vector<Vec6> y_;
    std::vector<std::pair<int, int>> edges_;
    std::vector<char> varies_;  // for each body, whether it has a row that is not linear
    BlockLu lu_;
    Work* work_ = nullptr;
    bool kept_ = false;  // whether the matrix already contains the contribution of the linear rows
    bool finite_ = true;
};

extern template class BodySystem<3>;
extern template class BodySystem<4>;

}  // namespace dihaptic::contact
