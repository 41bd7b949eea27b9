#include "contact/body_system.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::contact {
namespace {

/// Returns L with L L' = A for a positive semi-definite A; a zero pivot gives a zero column.
Mat6 root(const Mat6& A) noexcept {
    Mat6 L = Mat6::Zero();
    // rows for translation and rotation have different units, so their pivots differ in size
    const double linear = 1e-14 * A.diagonal().head<3>().maxCoeff();
    const double angular = 1e-14 * A.diagonal().tail<3>().maxCoeff();
    for (int k = 0; k < 6; ++k) {
        double pivot = A(k, k);
        for (int i = 0; i < k; ++i) pivot -= L(k, i) * L(k, i);
        if (pivot <= (k < 3 ? linear : angular)) continue;
        L(k, k) = std::sqrt(pivot);
        for (int i = k + 1; i < 6; ++i) {
            double sum = A(i, k);
            for (int j = 0; j < k; ++j) sum -= L(i, j) * L(k, j);
            L(i, k) = sum / L(k, k);
        }
    }
    return L;
}

}  // namespace

template <int Dim>
void BodySystem<Dim>::reserve(int bodies, int contacts, int joints) {
    rows_.reserve(static_cast<size_t>(contacts) + static_cast<size_t>(joints));
    joints_.reserve(static_cast<size_t>(joints));
    root_.reserve(static_cast<size_t>(bodies));
    y_.reserve(static_cast<size_t>(bodies));
    edges_.reserve(static_cast<size_t>(contacts) + static_cast<size_t>(joints));
    varies_.reserve(static_cast<size_t>(bodies));
    lu_.reserve(bodies, contacts + joints);
}

template <int Dim>
void BodySystem<Dim>::assemble(const ContactProblem& problem) noexcept {
    const size_t bodies = problem.bodies.size();
    root_.resize(bodies);
    y_.resize(bodies);
    const size_t contacts = problem.contacts.size();
    rows_.resize(contacts + problem.joints.size());
    joints_.resize(problem.joints.size());
    finite_ = true;
    for (size_t i = 0; i < bodies; ++i) {
        root_[i] = root(problem.bodies[i].inverse_mass);
        // must be checked here: the square root would hide non-finite values
        finite_ = finite_ && std::isfinite(problem.bodies[i].inverse_mass.sum());
    }
    for (size_t j = 0; j < contacts; ++j) assemble_row(problem, problem.contacts[j], rows_[j]);
    for (size_t j = 0; j < joints_.size(); ++j)
        assemble_joint(problem, problem.joints[j], rows_[contacts + j], joints_[j]);
}

template <int Dim>
bool BodySystem<Dim>::prepare_newton() noexcept {
    edges_.clear();
    varies_.assign(root_.size(), joints_.empty());
    kept_ = false;
    for (const ContactRows& row : rows_) {
        if (!is_linear(row)) {
            if (row.a != kFixed) varies_[static_cast<size_t>(row.a)] = 1;
            if (row.b != kFixed) varies_[static_cast<size_t>(row.b)] = 1;
        }
        if (row.a == kFixed || row.b == kFixed) continue;
        const std::pair<int, int> edge = std::minmax(row.a, row.b);
        if (edges_.empty() || edges_.back() != edge) edges_.push_back(edge);
    }
    if (!lu_.analyse(static_cast<int>(root_.size()), edges_, varies_)) return false;
    for (ContactRows& row : rows_) find_blocks(row);
    return true;
}

template <int Dim>
void BodySystem<Dim>::find_blocks(ContactRows& row) const noexcept {
    if (row.a != kFixed) row.aa = lu_.slot(row.a, row.a);
    if (row.b != kFixed) row.bb = lu_.slot(row.b, row.b);
    if (row.a != kFixed && row.b != kFixed) {
        row.ab = lu_.slot(row.a, row.b);
        row.ba = lu_.slot(row.b, row.a);
    }
}

/// Assembles a contact's rows, scaled so that their mean diagonal is 1.
template <int Dim>
void BodySystem<Dim>::assemble_row(const ContactProblem& problem, const ProblemContact& contact,
                                   ContactRows& row) noexcept {
    row.a = contact.a;
    row.b = contact.b;
    Vec diagonal = Vec::Zero();
    row.q.setZero();
    const auto fill = [&](Ht& H_t, int index, const Vec3& arm, double sign) {
        if (index == kFixed) {
            H_t.setZero();
            return;
        }
        const ProblemBody& body = problem.bodies[static_cast<size_t>(index)];
        const auto& L = root_[static_cast<size_t>(index)];
        const Row<D> J = sign * contact_row<D>(contact, arm);
        H_t.noalias() = L.transpose() * J.transpose();
        diagonal += H_t.colwise().squaredNorm().transpose();
        row.q.noalias() += J.template leftCols<3>() * body.v_W;
        row.q.noalias() += J.template rightCols<3>() * body.w_W;
    };
    fill(row.Ht_a, contact.a, contact.p_AC_W, -1);
    fill(row.Ht_b, contact.b, contact.p_BC_W, 1);
    row.q[0] += contact.bias;
    row.q.template segment<2>(1) += contact.slip;
    // no contact if no impulse can separate the bodies, e.g. on rails deep inside a fixed body
    if (diagonal[0] == 0 && contact.compliance == 0) row.q[0] = std::max(row.q[0], 0.0);
    const int rows = D == 4 && diagonal[D - 1] > 0 ? 4 : 3;
    const double mean = diagonal.sum() / rows;
    row.unit = mean > 0 ? 1 / std::sqrt(mean) : 1;
    row.Ht_a *= row.unit;
    row.Ht_b *= row.unit;
    row.q *= row.unit;
    row.law.joint = nullptr;
    row.law.mu = contact.friction;
    row.compliance = contact.compliance * row.unit * row.unit;
    // the sum is not finite if any term overflows or is not a number
    finite_ = finite_ && std::isfinite(mean + row.q.squaredNorm() + row.law.mu + row.compliance);
    const double normal = diagonal[0] * row.unit * row.unit + row.compliance;
    const double tangent = (diagonal.sum() - diagonal[0]) * row.unit * row.unit / (rows - 1);
    row.law.a_n = normal > 0 ? 1 / normal : 1;
    row.law.a_t = tangent > 0 ? 1 / tangent : 1;
}

/// Assembles a joint's rows, scaled so that the mean diagonal of movable rows is 1.
template <int Dim>
void BodySystem<Dim>::assemble_joint(const ContactProblem& problem, const ProblemJoint& joint,
                                     ContactRows& row, JointScale& scale) noexcept {
    constexpr int kRows = ProblemJoint::kRows;
    row.a = joint.a;
    row.b = joint.b;
    row.Ht_a.setZero();
    row.Ht_b.setZero();
    row.q.setZero();
    Vec3 diagonal = Vec3::Zero();
    const auto fill = [&](Ht& H_t, int index, const ProblemJoint::Rows& J) {
        if (index == kFixed) return;
        const ProblemBody& body = problem.bodies[static_cast<size_t>(index)];
        H_t.template leftCols<kRows>().noalias() =
            root_[static_cast<size_t>(index)].transpose() * J.transpose();
        diagonal += H_t.template leftCols<kRows>().colwise().squaredNorm().transpose();
        row.q.template head<kRows>() +=
            J.template leftCols<3>() * body.v_W + J.template rightCols<3>() * body.w_W;
    };
    fill(row.Ht_a, joint.a, joint.J_a);
    fill(row.Ht_b, joint.b, joint.J_b);
    row.q.template head<kRows>() += joint.bias;
    const auto moving = (diagonal.array() > 0).count();
    const double mean = moving > 0 ? diagonal.sum() / static_cast<double>(moving) : 0;
    row.unit = mean > 0 ? 1 / std::sqrt(mean) : 1;
    row.Ht_a *= row.unit;
    row.Ht_b *= row.unit;
    row.q *= row.unit;
    row.law = {};
    row.law.joint = &scale;
    row.compliance = 0;
    scale.compliance = joint.compliance * row.unit * row.unit;
    scale.low = joint.low / row.unit;
    scale.high = joint.high / row.unit;
    scale.linear = true;
    for (int i = 0; i < kRows; ++i)
        scale.linear = scale.linear && (joint.low[i] == joint.high[i] || !scale.is_bounded(i));
    scale.W.setZero();
    for (const Ht* H_t : {&row.Ht_a, &row.Ht_b})
        scale.W.noalias() +=
            H_t->template leftCols<kRows>().transpose() * H_t->template leftCols<kRows>();
    const Vec3 stiffness = scale.W.diagonal() + scale.compliance;
    for (int i = 0; i < kRows; ++i) scale.a[i] = stiffness[i] > 0 ? 1 / stiffness[i] : 1;
    finite_ = finite_ && std::isfinite(mean + row.q.squaredNorm() + scale.compliance.sum()) &&
              !(joint.low.array() > joint.high.array()).any() && !joint.low.hasNaN() &&
              !joint.high.hasNaN();
}

template <int Dim>
void BodySystem<Dim>::gather(std::span<const Vec> r) noexcept {
    std::fill(y_.begin(), y_.end(), Vec6::Zero());
    for (size_t j = 0; j < rows_.size(); ++j) apply(rows_[j], r[j]);
}

template <int Dim>
void BodySystem<Dim>::velocity(std::span<const Vec> r, std::span<Vec> u) noexcept {
    work_->spend(Visits::velocity * static_cast<int64_t>(size()));
    gather(r);
    for (size_t j = 0; j < rows_.size(); ++j) {
        u[j] = rows_[j].q;
        add_velocity(rows_[j], u[j]);
        u[j][0] += rows_[j].compliance * r[j][0];
    }
}

/// With the compliance g of the normal n, (I + G (W + n g n')) d = -c is (I + G' W) d = -c' with
///
///     G' = G - s G n (n' G)    c' = c - s G n (n' c)    s = g / (1 + g n' G n)
template <int Dim>
void BodySystem<Dim>::soften(std::span<Linearised<D>> contacts) const noexcept {
    for (size_t j = 0; j < rows_.size(); ++j) {
        const double compliance = rows_[j].compliance;
        Linearised<D>& contact = contacts[j];
        if (compliance == 0 || contact.open) continue;
        const Vec column = compliance / (1 + compliance * contact.G(0, 0)) * contact.G.col(0);
        const Eigen::Matrix<double, 1, D> row = contact.G.row(0);
        const double c = contact.c[0];
        contact.G.noalias() -= column * row;
        contact.c.noalias() -= column * c;
    }
}

template <int Dim>
void BodySystem<Dim>::add_to_matrix(const ContactRows& row, const Linearised<D>& contact) noexcept {
    if (contact.open) return;
    const auto add = [&](int slot, const Ht& left, const Ht& G_right) {
        lu_.block(slot).noalias() += left.lazyProduct(G_right.transpose());
    };
    if (row.a != kFixed) {
        const Ht G_a = row.Ht_a.lazyProduct(contact.G.transpose());
        add(row.aa, row.Ht_a, G_a);
        if (row.b != kFixed) add(row.ba, row.Ht_b, G_a);
    }
    if (row.b != kFixed) {
        const Ht G_b = row.Ht_b.lazyProduct(contact.G.transpose());
        add(row.bb, row.Ht_b, G_b);
        if (row.a != kFixed) add(row.ab, row.Ht_a, G_b);
    }
}

template <int Dim>
void BodySystem<Dim>::newton_step(std::span<Linearised<D>> contacts, std::span<Vec> d) noexcept {
    work_->spend(step_visits());
    soften(contacts);
    if (!kept_) {
        lu_.set_identity();
        for (size_t j = 0; j < rows_.size(); ++j) {
            if (is_linear(rows_[j])) add_to_matrix(rows_[j], contacts[j]);
        }
        lu_.keep();
        kept_ = true;
    } else {
        lu_.again();
    }
    std::fill(y_.begin(), y_.end(), Vec6::Zero());
    for (size_t j = 0; j < rows_.size(); ++j) {
        apply(rows_[j], -contacts[j].c);
        if (!is_linear(rows_[j])) add_to_matrix(rows_[j], contacts[j]);
    }
    lu_.solve(y_);
    for (size_t j = 0; j < rows_.size(); ++j) {
        d[j] = -contacts[j].c;
        if (contacts[j].open) continue;
        Vec u = Vec::Zero();
        add_velocity(rows_[j], u);
        d[j].noalias() -= contacts[j].G * u;
    }
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> BodySystem<Dim>::delassus_block(size_t j, size_t k) const noexcept {
    Eigen::Matrix<double, D, D> out = Eigen::Matrix<double, D, D>::Zero();
    const ContactRows& row = rows_[j];
    const ContactRows& column = rows_[k];
    const auto add = [&](const Ht& H_j, int body_j, const Ht& H_k, int body_k) {
        if (body_j != kFixed && body_j == body_k) out.noalias() += H_j.transpose() * H_k;
    };
    add(row.Ht_a, row.a, column.Ht_a, column.a);
    add(row.Ht_a, row.a, column.Ht_b, column.b);
    add(row.Ht_b, row.b, column.Ht_a, column.a);
    add(row.Ht_b, row.b, column.Ht_b, column.b);
    if (j == k) out(0, 0) += row.compliance;
    return out;
}

template <int Dim>
void BodySystem<Dim>::body_velocity(std::span<const Vec> r) noexcept {
    gather(r);
}

template <int Dim>
Vec6 BodySystem<Dim>::change(int body) const noexcept {
    return root_[static_cast<size_t>(body)] * y_[static_cast<size_t>(body)];
}

template class BodySystem<3>;
template class BodySystem<4>;

}  // namespace dihaptic::contact
