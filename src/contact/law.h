// The law of one contact as an equation for Newton's method (Alart and Curnier 1991), in a proximal
// step about the impulse r_k:
//
//     u^ = u + rho (r - r_k)
//     Phi_N = r_N - max(0, r_N - a_N u^_N)
//     Phi_T = r_T - P_disc(mu g)(r_T - a_T u^_T)      g = max(0, r_N - a_N u^_N)
//
// With A = dPhi/du^ and B = dPhi/dr, Newton's step solves A (W + rho) d + B d = -Phi. Multiplying
// it by K = (B + rho A)^-1, which has a closed form for each state of the contact, gives
//
//     (I + G W) d = -c        G = K A,  c = K Phi
//
//     open      G = 0                                c = r
//     sticking  G = I / rho                          c = u^ / rho
//     sliding   G = [ 1/rho        0             ]   along z = (r_T - a_T u^_T), unit vector
//                   [ mu z/rho     beta (I - z z') ]  beta = a_T s / (1 - s + rho a_T s),
//                                                    s = mu g / |r_T - a_T u^_T|
//
// Each row of a joint satisfies r = clamp(r - a (u + gamma r)) between its bounds, with gamma the
// compliance:
//
//     between   G = 1 / (gamma + rho)                c = (u^ + gamma r) / (gamma + rho)
//     at a bound  G = 0                              c = r - bound
//
// Rows without bounds are linear equations, which Newton's method solves in a single step, however
// large the impulses are. For such rows, rho is kLinearRho or zero, so their G never changes.
//
// rho regularises a singular W (four coplanar contacts); it has no effect at the fixed point r =
// r_k. Impulses and velocities are those of a scaled system, in which the diagonal blocks of W have
// a mean of 1.
#pragma once

#include <algorithm>
#include <cmath>

#include "contact/polygon.h"
#include "contact/problem.h"

namespace dihaptic::contact {

/// Scaling and compliance of a joint's rows in a scaled system.
struct JointScale {
    Mat3 W = Mat3::Zero();
    Vec3 a = Vec3::Ones();  ///< 1 / (W_ii + compliance)
    Vec3 compliance = Vec3::Zero();
    Vec3 low = Vec3::Zero();
    Vec3 high = Vec3::Zero();
    bool linear = false;  ///< no row has bounds, except for rows that have no effect

    bool is_bounded(int row) const noexcept {
        return std::isfinite(low[row]) || std::isfinite(high[row]);
    }
};

/// The regularisation for rows without bounds: their compliance, or rho if there is hardly any
/// compliance, since a G much larger than 1 / rho would cost Newton's step its precision. A larger
/// rho would require many proximal steps for a chain of joints, because motions of the whole chain
/// barely change its rows.
constexpr double kLinearRho = 1e-7;
constexpr double kLeastCompliance = 1e-9;

/// Scaling factors of one contact, or of the rows of one joint, in a scaled system.
struct Scale {
    double mu = 0;
    double a_n = 1;                     ///< 1 / W_NN
    double a_t = 1;                     ///< 1 / mean diagonal of W_TT
    const JointScale* joint = nullptr;  ///< null for a contact
};

/// The contribution of one contact to a Newton step.
template <int D>
struct Linearised {
    Eigen::Matrix<double, D, D> G;
    Eigen::Matrix<double, D, 1> c;
    bool open = true;  ///< true if G is zero
};

namespace law {

/// The rows of a contact that a sweep reads and changes.
enum class Touches { all, normal, friction };
template <class Law>
constexpr Touches touches() {
    if constexpr (requires { Law::kTouches; }) return Law::kTouches;
    return Touches::all;
}

/// Functions for the rows of a joint, which do not depend on the contact law.
struct Joint {
    template <int D>
    static double linearise(const JointScale& joint, const Eigen::Matrix<double, D, 1>& r,
                            const Eigen::Matrix<double, D, 1>& u,
                            const Eigen::Matrix<double, D, 1>& r_k, double rho_of_contacts,
                            Linearised<D>& out) noexcept {
        out.G.setZero();
        out.c = r;  // rows that the joint does not use are zero
        out.open = true;
        double error = 0;
        for (int i = 0; i < ProblemJoint::kRows; ++i) {
            const double rho = joint.is_bounded(i)
                                   ? rho_of_contacts
                                   : (joint.compliance[i] < kLeastCompliance ? kLinearRho : 0);
            const double w = u[i] + rho * (r[i] - r_k[i]) + joint.compliance[i] * r[i];
            const double z = r[i] - joint.a[i] * w;
            const double nearest = std::clamp(z, joint.low[i], joint.high[i]);
            error += (r[i] - nearest) * (r[i] - nearest);
            if (z <= joint.low[i] || z >= joint.high[i]) {
                out.c[i] = r[i] - nearest;
                continue;
            }
            out.open = false;
            out.G(i, i) = 1 / (joint.compliance[i] + rho);
            out.c[i] = w * out.G(i, i);
        }
        return error;
    }
    /// Computes |r - clamp(r - (u + compliance r))|^2 for impulses that are `unit` times the scaled
    /// impulses and velocities that are 1 / `unit` times the scaled velocities.
    template <int D>
    static double residual(const JointScale& joint, const Eigen::Matrix<double, D, 1>& r,
                           const Eigen::Matrix<double, D, 1>& u, double unit = 1) noexcept {
        double sum = 0;
        for (int i = 0; i < ProblemJoint::kRows; ++i) {
            const double w = (u[i] + joint.compliance[i] * r[i]) / unit;
            const double impulse = unit * r[i];
            const double error =
                impulse - std::clamp(impulse - w, unit * joint.low[i], unit * joint.high[i]);
            sum += error * error;
        }
        return sum;
    }
    /// Updates r row by row; each row accounts for the changes already made in the rows before it.
    template <int D>
    static void relax(const JointScale& joint, Eigen::Matrix<double, D, 1>& r,
                      const Eigen::Matrix<double, D, 1>& u) noexcept {
        Vec3 now = u.template head<3>();
        for (int i = 0; i < ProblemJoint::kRows; ++i) {
            const double before = r[i];
            const double w = now[i] + joint.compliance[i] * before;
            r[i] = std::clamp(before - joint.a[i] * w, joint.low[i], joint.high[i]);
            now += (r[i] - before) * joint.W.col(i);
        }
    }
    template <int D>
    static void project(const JointScale& joint, Eigen::Matrix<double, D, 1>& r) noexcept {
        for (int i = 0; i < ProblemJoint::kRows; ++i)
            r[i] = std::clamp(r[i], joint.low[i], joint.high[i]);
    }
};

/// Linearises sliding or sticking on the disc with radius `radius`. Returns |Phi_T|^2 and fills in
/// the tangential part of G and c, without coupling to the normal. `slides` is set to whether the
/// impulse lies on the rim of the disc.
template <int D>
double linearise_disc(const Eigen::Matrix<double, D, 1>& r, const Eigen::Matrix<double, D, 1>& u,
                      double radius, double a_t, double rho, Linearised<D>& out,
                      Eigen::Matrix<double, D - 1, 1>& direction, bool& slides) noexcept {
    using Tangent = Eigen::Matrix<double, D - 1, 1>;
    const Tangent r_t = r.template tail<D - 1>();
    const Tangent u_t = u.template tail<D - 1>();
    const Tangent z = r_t - a_t * u_t;
    const double length = z.norm();
    slides = length > radius || radius <= 0;
    if (!slides) {
        for (int i = 1; i < D; ++i) {
            for (int k = 1; k < D; ++k) out.G(i, k) = i == k ? 1 / rho : 0;
            out.c[i] = u[i] / rho;
        }
        return (a_t * u_t).squaredNorm();
    }
    auto c = out.c.template tail<D - 1>();
    if (radius <= 0) {
        direction.setZero();
        out.G.template bottomRightCorner<D - 1, D - 1>().setZero();
        c = r_t;
        return r_t.squaredNorm();
    }
    direction = z / length;
    const double s = radius / length;
    const double across = 1 - s + rho * a_t * s;
    const double turning = a_t * s / across;
    const Tangent phi = r_t - radius * direction;
    const double along = direction.dot(phi);
    for (int i = 1; i < D; ++i) {
        for (int k = 1; k < D; ++k)
            out.G(i, k) = turning * ((i == k ? 1 : 0) - direction[i - 1] * direction[k - 1]);
    }
    c = direction * along + (phi - direction * along) / across;
    return phi.squaredNorm();
}

/// Linearises the normal part and sets the tangential part to zero; for an open contact, nothing
/// else is needed. Returns r_N - a_N u^_N.
template <int D>
double linearise_normal(const Scale& scale, const Eigen::Matrix<double, D, 1>& r,
                        const Eigen::Matrix<double, D, 1>& u, double rho,
                        Linearised<D>& out) noexcept {
    const double g = r[0] - scale.a_n * u[0];
    out.open = g <= 0;
    out.G.setZero();
    out.c = r;
    if (out.open) return g;
    out.G(0, 0) = 1 / rho;
    out.c[0] = u[0] / rho;
    return g;
}

/// Coulomb's law, with its normal and tangential parts together.
struct Coulomb {
    /// Cost per contact of a sweep, or of evaluating the residual of an answer (work.h).
    static constexpr int kVisits = 1;
    template <int D>
    static double linearise(const Scale& scale, const Eigen::Matrix<double, D, 1>& r,
                            const Eigen::Matrix<double, D, 1>& u, double rho, Linearised<D>& out,
                            size_t) noexcept {
        const double g = linearise_normal<D>(scale, r, u, rho, out);
        if (out.open) return r.squaredNorm();
        Eigen::Matrix<double, D - 1, 1> z;
        bool slides = false;
        const double error = linearise_disc<D>(r, u, scale.mu * g, scale.a_t, rho, out, z, slides);
        if (slides) {
            out.G.template bottomLeftCorner<D - 1, 1>() = scale.mu / rho * z;
            out.c.template tail<D - 1>() += scale.mu * (1 - rho * scale.a_n) * u[0] / rho * z;
        }
        const double phi_n = scale.a_n * u[0];
        return phi_n * phi_n + error;
    }
    template <int D>
    static double residual(const Scale& scale, const Eigen::Matrix<double, D, 1>& r,
                           const Eigen::Matrix<double, D, 1>& u, size_t) noexcept {
        return natural_map_squared<D>(r, u, scale.mu);
    }
    /// Takes a projected step along the velocity of this contact.
    template <int D>
    static void relax(const Scale& scale, Eigen::Matrix<double, D, 1>& r,
                      const Eigen::Matrix<double, D, 1>& u, size_t contact) noexcept {
        r[0] -= scale.a_n * u[0];
        r.template tail<D - 1>() -= scale.a_t * u.template tail<D - 1>();
        project<D>(scale, r, contact);
    }
    template <int D>
    static void project(const Scale& scale, Eigen::Matrix<double, D, 1>& r, size_t) noexcept {
        if (r[0] <= 0) {
            r.setZero();
            return;
        }
        const double tangent = r.template tail<D - 1>().norm();
        if (tangent > scale.mu * r[0]) r.template tail<D - 1>() *= scale.mu * r[0] / tangent;
    }
};

/// The law for normal impulses, with the tangential impulses held fixed. This is the contact
/// projection of staggered projections.
struct NormalOnly {
    static constexpr int kVisits = 1;
    static constexpr Touches kTouches = Touches::normal;
    template <int D>
    static double linearise(const Scale& scale, const Eigen::Matrix<double, D, 1>& r,
                            const Eigen::Matrix<double, D, 1>& u, double rho, Linearised<D>& out,
                            size_t) noexcept {
        const double g = r[0] - scale.a_n * u[0];
        out.open = g <= 0;
        out.G.setZero();
        out.c.setZero();
        if (out.open) {
            out.c[0] = r[0];
            return r[0] * r[0];
        }
        out.G(0, 0) = 1 / rho;
        out.c[0] = u[0] / rho;
        const double phi = scale.a_n * u[0];
        return phi * phi;
    }
    template <int D>
    static double residual(const Scale&, const Eigen::Matrix<double, D, 1>& r,
                           const Eigen::Matrix<double, D, 1>& u, size_t) noexcept {
        const double error = r[0] - std::max(0.0, r[0] - u[0]);
        return error * error;
    }
    template <int D>
    static void relax(const Scale& scale, Eigen::Matrix<double, D, 1>& r,
                      const Eigen::Matrix<double, D, 1>& u, size_t) noexcept {
        r[0] = std::max(0.0, r[0] - scale.a_n * u[0]);
    }
};

/// The law for tangential impulses on discs with the current radius mu r_N, in steps of 2 /
/// trace(W_TT). These steps keep sweeps stable however much the rows differ; the torsion row is
/// often by far the smallest.
struct FrictionOfLoad {
    static constexpr Touches kTouches = Touches::friction;
    template <int D>
    static void relax(const Scale& scale, Eigen::Matrix<double, D, 1>& r,
                      const Eigen::Matrix<double, D, 1>& u, size_t contact) noexcept {
        r.template tail<D - 1>() -= 2 * scale.a_t / (D - 1) * u.template tail<D - 1>();
        Coulomb::project<D>(scale, r, contact);
    }
};

/// Coulomb's law for sweeps that visit first all normal impulses, then all friction impulses. In
/// stacks, this leaves two thirds of the error that remains if each contact updates both at once.
struct NormalThenFriction {
    static constexpr int kVisits = 2;
    NormalOnly normal;
    FrictionOfLoad friction;
};

/// The law for tangential impulses on discs with fixed radius mu r_N. This is the friction
/// projection of staggered projections. Contacts without load have no friction and are left out.
struct FrictionOnly {
    static constexpr int kVisits = 1;
    std::span<const double> normal;  ///< normal impulse of each contact, in the scaled system

    template <int D>
    double linearise(const Scale& scale, const Eigen::Matrix<double, D, 1>& r,
                     const Eigen::Matrix<double, D, 1>& u, double rho, Linearised<D>& out,
                     size_t contact) const noexcept {
        Eigen::Matrix<double, D - 1, 1> z;
        bool slides = false;
        const double radius = scale.mu * normal[contact];
        out.open = radius <= 0;
        out.G.setZero();
        out.c.setZero();
        return linearise_disc<D>(r, u, radius, scale.a_t, rho, out, z, slides);
    }
    template <int D>
    double residual(const Scale& scale, const Eigen::Matrix<double, D, 1>& r,
                    const Eigen::Matrix<double, D, 1>& u, size_t contact) const noexcept {
        Eigen::Matrix<double, D - 1, 1> x = (r - u).template tail<D - 1>();
        const double radius = scale.mu * normal[contact];
        const double length = x.norm();
        if (length > radius) x *= radius / length;
        return (r.template tail<D - 1>() - x).squaredNorm();
    }
    template <int D>
    void relax(const Scale& scale, Eigen::Matrix<double, D, 1>& r,
               const Eigen::Matrix<double, D, 1>& u, size_t contact) const noexcept {
        r.template tail<D - 1>() -= scale.a_t * u.template tail<D - 1>();
        project<D>(scale, r, contact);
    }
    template <int D>
    void project(const Scale& scale, Eigen::Matrix<double, D, 1>& r,
                 size_t contact) const noexcept {
        const double radius = scale.mu * normal[contact];
        const double length = r.template tail<D - 1>().norm();
        if (length > radius) r.template tail<D - 1>() *= radius / length;
    }
};

/// Coulomb's law with the disc replaced by a polygon (Stewart and Trinkle) and the multipliers
/// eliminated.
template <int T>
struct Polygonal {
    static constexpr int kVisits = 6;
    std::span<const Polygon<T>> polygon;  ///< one polygon per contact
    using Tangent = Eigen::Matrix<double, T, 1>;

    template <int D>
    double linearise(const Scale& scale, const Eigen::Matrix<double, D, 1>& r,
                     const Eigen::Matrix<double, D, 1>& u, double rho, Linearised<D>& out,
                     size_t contact) const noexcept {
        static_assert(D == T + 1);
        const double g = linearise_normal<D>(scale, r, u, rho, out);
        if (out.open) return r.squaredNorm();
        const Tangent r_t = r.template tail<T>();
        const Tangent u_t = u.template tail<T>();
        const double radius = scale.mu * g;
        const auto on = polygon[contact].project(r_t - scale.a_t * u_t, radius);
        // P = radius * per_radius + F z, where F is the projector on the facet (zero at a vertex);
        // F plays the role that I - z z' has for a disc with s = 1
        const Tangent phi = r_t - on.point;
        auto G_t = out.G.template bottomRightCorner<T, T>();
        auto c_t = out.c.template tail<T>();
        if (on.inside) {
            G_t = Eigen::Matrix<double, T, T>::Identity() / rho;
            c_t = u_t / rho;
        } else {
            G_t = on.along / rho;
            c_t = phi - on.along * phi + on.along * u_t / rho +
                  scale.mu * (1 - rho * scale.a_n) * u[0] / rho * on.per_radius;
            out.G.template bottomLeftCorner<T, 1>() = scale.mu / rho * on.per_radius;
        }
        const double phi_n = scale.a_n * u[0];
        return phi_n * phi_n + phi.squaredNorm();
    }
    template <int D>
    void relax(const Scale& scale, Eigen::Matrix<double, D, 1>& r,
               const Eigen::Matrix<double, D, 1>& u, size_t contact) const noexcept {
        r[0] = std::max(0.0, r[0] - scale.a_n * u[0]);
        const Tangent x = r.template tail<T>() - scale.a_t * u.template tail<T>();
        r.template tail<T>() = polygon[contact].project(x, scale.mu * r[0]).point;
    }
};

/// The following functions use the contact law for a contact, and a joint's own rows for a joint.
/// The first function is for a proximal step about r_k.
template <int D, class Law>
double linearise(const Law& law, const Scale& scale, const Eigen::Matrix<double, D, 1>& r,
                 const Eigen::Matrix<double, D, 1>& u, const Eigen::Matrix<double, D, 1>& r_k,
                 double rho, Linearised<D>& out, size_t j) noexcept {
    if (scale.joint != nullptr) return Joint::linearise<D>(*scale.joint, r, u, r_k, rho, out);
    return law.template linearise<D>(scale, r, u + rho * (r - r_k), rho, out, j);
}
template <int D, class Law>
double residual(const Law& law, const Scale& scale, const Eigen::Matrix<double, D, 1>& r,
                const Eigen::Matrix<double, D, 1>& u, size_t j) noexcept {
    if (scale.joint != nullptr) return Joint::residual<D>(*scale.joint, r, u);
    return law.template residual<D>(scale, r, u, j);
}
template <int D, class Law>
void relax(const Law& law, const Scale& scale, Eigen::Matrix<double, D, 1>& r,
           const Eigen::Matrix<double, D, 1>& u, size_t j) noexcept {
    if (scale.joint != nullptr) return Joint::relax<D>(*scale.joint, r, u);
    law.template relax<D>(scale, r, u, j);
}
template <int D, class Law>
void project(const Law& law, const Scale& scale, Eigen::Matrix<double, D, 1>& r,
             size_t j) noexcept {
    if (scale.joint != nullptr) return Joint::project<D>(*scale.joint, r);
    law.template project<D>(scale, r, j);
}

}  // namespace law
}  // namespace dihaptic::contact
