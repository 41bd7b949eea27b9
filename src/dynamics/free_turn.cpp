#include "dynamics/free_turn.h"

#include <array>
#include <cmath>

namespace dihaptic::dynamics {
namespace {

/// The series converges in a few terms over an interval in which the body turns by less than this
/// [rad]: each term is smaller than the previous one by at least this factor.
constexpr double kStretch = 0.2;
constexpr size_t kMostTerms = 24;
/// A term smaller than this has no effect in a sum of about one.
constexpr double kNothing = 1e-17;

/// Advances q and w, in the body's axes, by h. The components of `a` are (I_y - I_z) / I_x and so
/// on.
void advance(const Vec3& a, double h, Quat& q, Vec3& w) noexcept {
    // Taylor coefficients of h w and of q, in powers of t / h
    std::array<Vec3, kMostTerms + 1> W;
    std::array<Quat, kMostTerms + 1> Q;
    W[0] = h * w;
    Q[0] = Quat::Identity();
    Vec3 w_sum = W[0];
    Eigen::Vector4d q_sum = Q[0].coeffs();
    double last = 1;
    for (size_t k = 0; k < kMostTerms; ++k) {
        Vec3 products = Vec3::Zero();
        Eigen::Vector4d turned = Eigen::Vector4d::Zero();
        for (size_t j = 0; j <= k; ++j) {
            const Vec3& u = W[j];
            const Vec3& v = W[k - j];
            products += Vec3(u.y() * v.z(), u.z() * v.x(), u.x() * v.y());
            turned += (Q[j] * Quat(0, v.x(), v.y(), v.z())).coeffs();
        }
        const double order = static_cast<double>(k + 1);
        W[k + 1] = a.cwiseProduct(products) / order;
        Q[k + 1] = Quat(Eigen::Vector4d(turned / (2 * order)));
        w_sum += W[k + 1];
        q_sum += Q[k + 1].coeffs();
        const double now = std::max(W[k + 1].norm(), Q[k + 1].norm());
        if (now < kNothing && last < kNothing) break;  // every second term may be zero
        last = now;
    }
    w = w_sum / h;
    q = q * Quat(q_sum).normalized();
}

}  // namespace

Vec3 mean_velocity(const Quat& R_WM, const Vec3& inertia, const Vec3& w_W, double h) noexcept {
    const Vec3 a((inertia.y() - inertia.z()) / inertia.x(),
                 (inertia.z() - inertia.x()) / inertia.y(),
                 (inertia.x() - inertia.y()) / inertia.z());
    Vec3 w = R_WM.conjugate() * w_W;
    const double turn = h * w.norm();
    if (a.isZero(0) || !(turn > 0)) return w_W;
    const int stretches = 1 + static_cast<int>(std::min(turn, 100.0) / kStretch);
    Quat q = Quat::Identity();
    for (int i = 0; i < stretches; ++i) advance(a, h / stretches, q, w);
    return R_WM * rotation_vector(q) / h;
}

}  // namespace dihaptic::dynamics
