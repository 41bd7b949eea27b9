// BodySystem is the contact problem in body space, scaled: u = H y + q, y = H' r, W = H H'. W is
// never formed; Newton's equation is solved by a matrix over the bodies instead (Woodbury):
//
//     (I + G H H') d = -c   <=>   (I + H' G H) y = -H' c,   d = -c - G H y
//
// H contains the inverse square roots of mass and inertia, and each contact's rows are divided by
// the root of the mean diagonal of its block of W. Impulses are then r = scale * r^, velocities u =
// u^ / scale, and nothing depends on units. Soft contacts add their compliance to the diagonal of
// W.
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
    /// Allocates if the problem is larger than reserved.
    void assemble(const ContactProblem& problem) noexcept;
    /// Counts the work of all following calls.
    void count_in(Work& work) noexcept { work_ = &work; }
    Work& work() const noexcept { return *work_; }
    /// Cost of a step of Newton's method, without the contact law [visits].
    int64_t step_visits() const noexcept {
        return Visits::matrix * static_cast<int64_t>(size()) + Visits::product * lu_.products();
    }
    /// Finds the matrix for newton_step(). False if the matrix is larger than reserved.
    bool prepare_newton() noexcept;

    /// Contacts, then joints.
    size_t size() const noexcept { return rows_.size(); }
    bool has_joints() const noexcept { return !joints_.empty(); }
    /// Whether every number in the problem is finite and usable.
    bool is_finite() const noexcept { return finite_; }
    const Scale& scale(size_t j) const noexcept { return rows_[j].law; }
    const Vec& q(size_t j) const noexcept { return rows_[j].q; }
    /// Ratio of an impulse to the scaled impulse.
    double unit(size_t j) const noexcept { return rows_[j].unit; }

    /// u = W r + q.
    void velocity(std::span<const Vec> r, std::span<Vec> u) noexcept;
    /// Solves (I + G W) d = -c; changes G and c.
    void newton_step(std::span<Linearised<D>> contacts, std::span<Vec> d) noexcept;
    /// Does projected Gauss-Seidel sweeps on a law, until a sweep changes no contact's velocity by
    /// more than `enough` [m/s], or until the allowed work is used up. Returns the number of
    /// sweeps.
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
    /// Block of W for contacts j (rows) and k (columns).
    Eigen::Matrix<double, Dim, Dim> delassus_block(size_t j, size_t k) const noexcept;

    /// Computes the changes of all bodies' velocities due to impulses; change() returns one body's:
    /// linear, then angular.
    void body_velocity(std::span<const Vec> r) noexcept;
    Vec6 change(int body) const noexcept;

  private:
    /// One sweep; returns the square of the largest change of a contact's velocity.
    template <class Law>
    double pass(const Law& law, std::span<Vec> r) noexcept {
        double most = 0;
        for (size_t j = 0; j < rows_.size(); ++j) {
            const ContactRows& row = rows_[j];
            Vec u = row.q;
            add_velocity(row, u);
            u[0] += row.compliance * r[j][0];
            const Vec before = r[j];
            law::relax<D>(law, row.law, r[j], u, j);
            const Vec change = r[j] - before;
            apply(row, change);
            most = std::max(most, change.squaredNorm() / (row.unit * row.unit));
        }
        return most;
    }
    double pass(const law::NormalThenFriction& law, std::span<Vec> r) noexcept {
        const double change = pass(law.normal, r);
        return std::max(change, pass(law.friction, r));
    }

    /// Transposed, so that a column fills whole SIMD packets.
    using Ht = Eigen::Matrix<double, 6, D>;
    struct ContactRows {
        Ht Ht_a;
        Ht Ht_b;
        Vec q;
        Scale law;
        double unit = 1;
        double compliance = 0;  // of a contact along its normal; a joint's is in `law`
        int a = kFixed;
        int b = kFixed;
        int aa = -1, bb = -1, ab = -1, ba = -1;  // indices of blocks in the matrix of bodies
    };

    void assemble_row(const ContactProblem& problem, const ProblemContact& contact,
                      ContactRows& row) noexcept;
    void assemble_joint(const ContactProblem& problem, const ProblemJoint& joint, ContactRows& row,
                        JointScale& scale) noexcept;
    void find_blocks(ContactRows& row) const noexcept;
    /// Whether a row's G is the same in every step of Newton's method.
    static bool is_linear(const ContactRows& row) noexcept {
        return row.law.joint != nullptr && row.law.joint->linear;
    }
    /// Adds H' G H of one contact or joint to the matrix.
    void add_to_matrix(const ContactRows& row, const Linearised<D>& contact) noexcept;
    /// Moves the compliance of contacts from W to G and c.
    void soften(std::span<Linearised<D>> contacts) const noexcept;
    void gather(std::span<const Vec> r) noexcept;
    /// Adds one contact's H' r to y.
    void apply(const ContactRows& row, const Vec& r) noexcept {
        if (row.a != kFixed) y_[static_cast<size_t>(row.a)].noalias() += row.Ht_a * r;
        if (row.b != kFixed) y_[static_cast<size_t>(row.b)].noalias() += row.Ht_b * r;
    }
    /// Adds one contact's H y to u.
    void add_velocity(const ContactRows& row, Vec& u) const noexcept {
        if (row.a != kFixed) u.noalias() += row.Ht_a.transpose() * y_[static_cast<size_t>(row.a)];
        if (row.b != kFixed) u.noalias() += row.Ht_b.transpose() * y_[static_cast<size_t>(row.b)];
    }

    std::vector<ContactRows> rows_;
    std::vector<JointScale> joints_;
    std::vector<Mat6> root_;  // of the inverse mass matrix, by body
    std::vector<Vec6> y_;
    std::vector<std::pair<int, int>> edges_;
    std::vector<char> varies_;  // by body: whether it has a row that is not linear
    BlockLu lu_;
    Work* work_ = nullptr;
    bool kept_ = false;  // whether the matrix contains the linear rows' contribution
    bool finite_ = true;
};

extern template class BodySystem<3>;
extern template class BodySystem<4>;

}  // namespace dihaptic::contact
