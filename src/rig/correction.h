// The correction of one device, which converts what the device reports to the position of its
// endpoint, in the D of the rig file:
//
//     p' = X f(reading)        f = FK(q + offset)        for devices that report joint angles q
//                              f = (I + S) p             for others; S symmetric
//     v' = A v                 A = R J(q + offset) J(q)^-1        or R (I + S)
//     f  = A^T f'              which conserves power: f . v = f' . v'
//
// X is the pose of the true D in the file's D, and R its rotation; FK and J are the arm's forward
// kinematics and Jacobian. With joint angles, the transpose is also exact for the motors: the
// device's driver produces the torques J(q)^T f, which result in the force f' at the true angles.
#pragma once

#include <optional>

#include "devices/device_group.h"
#include "model/phantom_arm.h"

namespace dihaptic::rig {

struct Correction {
    Pose X;
    std::optional<model::PhantomLinks> arm;  ///< for a device that reports joint angles
    Vec3 joint_offset = Vec3::Zero();        ///< true minus reported joint angles [rad]
    Mat3 stretch = Mat3::Zero();             ///< S: stretch on the diagonal, skew off the diagonal

    /// f [m].
    Vec3 shaped(const Vec3& p_DH, const Vec3& joints) const noexcept {
        if (arm) return model::phantom_position(*arm, joints + joint_offset);
        return p_DH + stretch * p_DH;
    }
    /// p' [m].
    Vec3 position(const Vec3& p_DH, const Vec3& joints) const noexcept {
        return X * shaped(p_DH, joints);
    }
    /// The matrix A, or R if the arm is stretched or folded so that J(q) has no inverse.
    Mat3 slope(const Vec3& joints) const noexcept;
};

}  // namespace dihaptic::rig
