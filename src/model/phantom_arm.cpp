#include "model/phantom_arm.h"

#include <algorithm>
#include <cmath>

#include "base/unit.h"
#include "model/gravity.h"

namespace dihaptic::model {
namespace {

/// Distance of the endpoint from the turret's axis [m].
double rho(const PhantomLinks& links, const Vec3& q) {
    return links.thigh * std::cos(q[1]) + links.shin * std::sin(q[2]);
}

/// The parts of a Premium 1.5: a is the shin with the endpoint, c is the bar parallel to the thigh,
/// be is the thigh with its motor, and df is the bar that drives the shin, with its motor [m, kg,
/// kg*m^2].
struct Parts {
    double l1 = 0.215, l2 = 0.170, l3 = 0.0325, l5 = -0.0368, l6 = 0.0527;
    double m_a = 0.0202, m_c = 0.0249, m_be = 0.2359, m_df = 0.1906;
    Vec3 I_a{0.4864e-4, 0.00184e-4, 0.4864e-4};
    Vec3 I_c{0.959e-4, 0.959e-4, 0.0051e-4};
    Vec3 I_be{11.09e-4, 10.06e-4, 0.591e-4};
    Vec3 I_df{7.11e-4, 0.629e-4, 6.246e-4};
    double I_base_y = 11.87e-4;

    /// `thigh` and `shin`: lengths relative to those of the Premium 1.5.
    void scale(double thigh, double shin) {
        const auto part = [](double& mass, Vec3& inertia, double by) {
            mass *= by;
            inertia *= by * by * by;
        };
        part(m_a, I_a, shin);
        part(m_c, I_c, thigh);
        part(m_be, I_be, thigh);
        part(m_df, I_df, thigh);
        I_base_y *= thigh * thigh * thigh;
        for (double* length : {&l1, &l3, &l5, &l6}) *length *= thigh;
        l2 *= shin;
    }

    PhantomDynamics sums() const {
        const double l1_2 = l1 * l1, l2_2 = l2 * l2, l3_2 = l3 * l3;
        const auto yz = [](const Vec3& inertia, double sign) {
            return (inertia.y() + sign * inertia.z()) / 2;
        };
        const double thigh = l1_2 * (m_a / 2 + m_c / 8);
        const double shin = l2_2 * m_a / 8 + l3_2 * m_c / 2;
        PhantomDynamics out;
        out.m0 = I_base_y + yz(I_a, 1) + yz(I_be, 1) + yz(I_c, 1) + yz(I_df, 1) + thigh + shin;
        out.m_thigh = yz(I_be, -1) + yz(I_c, -1) + thigh;
        out.m_shin = yz(I_a, -1) + yz(I_df, -1) - shin;
        out.m_both = l1 * (l2 * m_a + l3 * m_c);
        out.m22 = I_be.x() + I_c.x() + l1_2 * (m_a + m_c / 4);
        out.m33 = I_a.x() + I_df.x() + l2_2 * m_a / 4 + l3_2 * m_c;
        out.g_thigh = kGravity / 2 * (2 * l1 * m_a + 2 * l5 * m_be + l1 * m_c);
        out.g_shin = kGravity / 2 * (l2 * m_a + 2 * l3 * m_c - 2 * l6 * m_df);
        return out;
    }
};

}  // namespace

const PhantomLimits& phantom_limits() {
    static const PhantomLimits limits{Vec3(-90, -45, -60) * kDegree, Vec3(90, 90, 90) * kDegree,
                                      -55 * kDegree, 65 * kDegree};
    return limits;
}

Vec3 phantom_position(const PhantomLinks& links, const Vec3& q) noexcept {
    const double r = rho(links, q);
    return {r * std::sin(q[0]), links.thigh * std::sin(q[1]) + links.shin * (1 - std::cos(q[2])),
            r * std::cos(q[0]) - links.thigh};
}

Mat3 phantom_jacobian(const PhantomLinks& links, const Vec3& q) noexcept {
    const double s1 = std::sin(q[0]), c1 = std::cos(q[0]);
    const double s2 = std::sin(q[1]), c2 = std::cos(q[1]);
    const double s3 = std::sin(q[2]), c3 = std::cos(q[2]);
    const double r = rho(links, q);
    Mat3 J;
    J.col(0) << r * c1, 0, -r * s1;
    J.col(1) = links.thigh * Vec3(-s1 * s2, c2, -c1 * s2);
    J.col(2) = links.shin * Vec3(s1 * c3, s3, c1 * c3);
    return J;
}

Vec3 phantom_steady_acceleration(const PhantomLinks& links, const Vec3& q,
                                 const Vec3& rate) noexcept {
    const double s1 = std::sin(q[0]), c1 = std::cos(q[0]);
    const double s2 = std::sin(q[1]), c2 = std::cos(q[1]);
    const double s3 = std::sin(q[2]), c3 = std::cos(q[2]);
    const Vec3 square = rate.cwiseProduct(rate);
    const double r = rho(links, q);
    const double r1 = -links.thigh * s2 * rate[1] + links.shin * c3 * rate[2];
    const double r2 = -links.thigh * c2 * square[1] - links.shin * s3 * square[2];
    return {r2 * s1 + 2 * r1 * c1 * rate[0] - r * s1 * square[0],
            -links.thigh * s2 * square[1] + links.shin * c3 * square[2],
            r2 * c1 - 2 * r1 * s1 * rate[0] - r * c1 * square[0]};
}

double phantom_determinant(const PhantomLinks& links, const Vec3& q) noexcept {
    return links.thigh * links.shin * rho(links, q) * std::cos(q[1] - q[2]);
}

Vec3 phantom_joints(const PhantomLinks& links, const Vec3& p_DH) noexcept {
    const double l1 = links.thigh, l2 = links.shin;
    const double out = std::hypot(p_DH.x(), p_DH.z() + l1);  // distance from the turret's axis: rho
    const double up = p_DH.y() - l2;                         // height above the shoulder
    // out^2 + up^2 = l1^2 + l2^2 - 2 l1 l2 sin(q2 - q3), with |q2 - q3| within 90 degrees
    const double sine = (l1 * l1 + l2 * l2 - out * out - up * up) / (2 * l1 * l2);
    const double bend = std::asin(std::clamp(sine, -1.0, 1.0));
    // (out, up) is (l1 - l2 sin(bend), -l2 cos(bend)) rotated by q2, where bend = q2 - q3
    const double thigh =
        std::atan2(up, out) - std::atan2(-l2 * std::cos(bend), l1 - l2 * std::sin(bend));
    return {std::atan2(p_DH.x(), p_DH.z() + l1), thigh, thigh - bend};
}

bool phantom_allows(const Vec3& q) noexcept {
    const PhantomLimits& limits = phantom_limits();
    const double bend = q[1] - q[2];
    return (q.array() >= limits.low.array()).all() && (q.array() <= limits.high.array()).all() &&
           bend >= limits.bend_low && bend <= limits.bend_high;
}

bool phantom_reaches(const PhantomLinks& links, const Vec3& p_DH) noexcept {
    constexpr double kSame = 1e-9;  // [m]
    const Vec3 q = phantom_joints(links, p_DH);
    return phantom_allows(q) && (phantom_position(links, q) - p_DH).norm() < kSame;
}

PhantomDynamics PhantomDynamics::premium_1_5() {
    return Parts{}.sums();
}

PhantomDynamics PhantomDynamics::scaled(const PhantomLinks& links) {
    Parts parts;
    parts.scale(links.thigh / parts.l1, links.shin / parts.l2);
    return parts.sums();
}

Mat3 phantom_mass_matrix(const PhantomDynamics& arm, const Vec3& q) noexcept {
    Mat3 M = Mat3::Zero();
    M(0, 0) = arm.m0 + arm.m_thigh * std::cos(2 * q[1]) + arm.m_shin * std::cos(2 * q[2]) +
              arm.m_both * std::cos(q[1]) * std::sin(q[2]);
    M(1, 1) = arm.m22;
    M(2, 2) = arm.m33;
    M(1, 2) = M(2, 1) = -arm.m_both / 2 * std::sin(q[1] - q[2]);
    return M;
}

Vec3 phantom_coriolis(const PhantomDynamics& arm, const Vec3& q, const Vec3& rate) noexcept {
    // dM11/dq2, dM11/dq3 and dM23/dq3 = -dM23/dq2; no other element of M depends on q
    const double d2 =
        -2 * arm.m_thigh * std::sin(2 * q[1]) - arm.m_both * std::sin(q[1]) * std::sin(q[2]);
    const double d3 =
        -2 * arm.m_shin * std::sin(2 * q[2]) + arm.m_both * std::cos(q[1]) * std::cos(q[2]);
    const double d23 = arm.m_both / 2 * std::cos(q[1] - q[2]);
    return {rate[0] * (d2 * rate[1] + d3 * rate[2]),
            -d2 / 2 * rate[0] * rate[0] + d23 * rate[2] * rate[2],
            -d3 / 2 * rate[0] * rate[0] - d23 * rate[1] * rate[1]};
}

Vec3 phantom_gravity(const PhantomDynamics& arm, const Vec3& q) noexcept {
    return {0, arm.g_thigh * std::cos(q[1]), arm.g_shin * std::sin(q[2])};
}

double phantom_energy(const PhantomDynamics& arm, const Vec3& q, const Vec3& rate) noexcept {
    return rate.dot(phantom_mass_matrix(arm, q) * rate) / 2 + arm.g_thigh * std::sin(q[1]) +
           arm.g_shin * (1 - std::cos(q[2]));
}

}  // namespace dihaptic::model
