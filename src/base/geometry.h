// Vectors, rotations and poses, in the monogram notation of docs/conventions.md: X_AB is the pose
// of frame B in frame A, p_AB is the position of B's origin in A, and R_AB is the rotation of B in
// A. Adjacent letters match in every product: X_AC = X_AB * X_BC, p_AC = X_AB * p_BC.
#pragma once

#include <Eigen/Dense>

namespace dihaptic {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
/// Unit quaternion. It has no extra alignment, so that records that contain one can be copied byte
/// by byte.
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;

/// Rigid pose X_AB of frame B in frame A.
struct Pose {
    Quat R = Quat::Identity();  ///< R_AB
    Vec3 p = Vec3::Zero();      ///< p_AB [m]

    /// Transforms a point: p_AC from p_BC [m].
    Vec3 operator*(const Vec3& p_BC) const { return R * p_BC + p; }
    Pose operator*(const Pose& X_BC) const { return {R * X_BC.R, R * X_BC.p + p}; }
    Pose inverse() const {
        const Quat back = R.conjugate();
        return {back, -(back * p)};
    }
};

/// Rotation about the fixed axes x, then y, then z, by the given angles [rad].
inline Quat rotation_xyz(const Vec3& angles) {
    return Quat(Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) *
                Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
                Eigen::AngleAxisd(angles.x(), Vec3::UnitX()));
}

/// The angles of rotation_xyz() [rad]; the angle about y is between -pi / 2 and pi / 2. At either
/// end of that range, only the sum or the difference of the other two angles is determined, and the
/// angle about z is set to 0.
inline Vec3 angles_xyz(const Quat& R_AB) {
    const Mat3 R = R_AB.toRotationMatrix();
    const double cosine = std::hypot(R(0, 0), R(1, 0));
    if (cosine < 1e-9) return {std::atan2(-R(1, 2), R(1, 1)), std::atan2(-R(2, 0), cosine), 0};
    return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), cosine),
            std::atan2(R(1, 0), R(0, 0))};
}

/// Exponential map: the rotation about the direction of r by the angle |r| [rad].
inline Quat rotation_by(const Vec3& r) {
    const double angle = r.norm();
    if (angle == 0) return Quat::Identity();
    return Quat(Eigen::AngleAxisd(angle, r / angle));
}

/// Logarithmic map, the inverse of rotation_by(): the axis times the angle, which is at most pi
/// [rad].
inline Vec3 rotation_vector(const Quat& R) {
    const double sine = R.vec().norm();
    // for an angle this small, 2 sin(angle / 2) equals the angle
    if (sine < 1e-12) return (R.w() < 0 ? -2.0 : 2.0) * R.vec();
    const double angle = 2 * std::atan2(R.w() < 0 ? -sine : sine, std::abs(R.w()));
    return angle / sine * R.vec();
}

/// A force on a handle or a body, and a torque about the origin of that handle or body.
struct Wrench {
    Vec3 force = Vec3::Zero();   ///< [N]
    Vec3 torque = Vec3::Zero();  ///< [N*m]

    bool is_zero() const { return force == Vec3::Zero() && torque == Vec3::Zero(); }
};

/// Angle of the smallest rotation from A to B [rad].
inline double angle_between(const Quat& R_A, const Quat& R_B) {
    const Quat between = R_A.conjugate() * R_B;
    return 2.0 * std::atan2(between.vec().norm(), std::abs(between.w()));
}

}  // namespace dihaptic
