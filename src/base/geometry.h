// Vectors, rotations and poses, in the monogram notation of docs/conventions.md: X_AB is the pose
// of frame B in frame A, p_AB the position of B's origin in A, R_AB the rotation of B in A.
// Adjacent letters match in every product: X_AC = X_AB * X_BC, p_AC = X_AB * p_BC.
#pragma once

#include <Eigen/Dense>

namespace dihaptic {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
/// Unit quaternion. Not over-aligned, so that records which hold one can be copied byte by byte.
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;

/// Rigid pose X_AB of frame B in frame A.
struct Pose {
    Quat R = Quat::Identity();  ///< R_AB
    Vec3 p = Vec3::Zero();      ///< p_AB [m]

    /// p_AC from p_BC [m].
    Vec3 operator*(const Vec3& p_BC) const { return R * p_BC + p; }
    Pose operator*(const Pose& X_BC) const { return {R * X_BC.R, R * X_BC.p + p}; }
    Pose inverse() const {
        const Quat back = R.conjugate();
        return {back, -(back * p)};
    }
};

/// Rotation by rotations about the fixed axes x, then y, then z [rad].
inline Quat rotation_xyz(const Vec3& angles) {
    return Quat(Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) *
                Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
                Eigen::AngleAxisd(angles.x(), Vec3::UnitX()));
}

/// Angle of the smallest rotation that takes A to B [rad].
inline double angle_between(const Quat& R_A, const Quat& R_B) {
    const Quat between = R_A.conjugate() * R_B;
    return 2.0 * std::atan2(between.vec().norm(), std::abs(between.w()));
}

}  // namespace dihaptic
