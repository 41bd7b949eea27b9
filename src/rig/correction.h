// From what a device reports to where its endpoint is, in the axes of D as the rig file has D:
//
//     p' = X f(reading)        f = FK(q + offset)        of devices that tell their joints' angles
//                              f = (I + S) p             of others; S symmetric
//     v' = A v                 A = R J(q + offset) J(q)^-1        or R (I + S)
//     f  = A^T f'              which keeps power: f . v = f' . v'
//
// X: pose of the true D in that of the file, R its rotation; J the arm's Jacobian. With joints, the
// transpose is exact too: the device's driver makes torques J(q)^T f, and at the true angles they
// give the force f'.
#pragma once

#include <optional>

#include "devices/device_group.h"

namespace dihaptic::rig {

struct Correction {
    Pose X;
    std::optional<model::PhantomLinks> arm;  ///< of a device that tells its joints' angles
    Vec3 joint_offset = Vec3::Zero();        ///< true less reported [rad]
    Mat3 stretch = Mat3::Zero();             ///< S: scale, and skew off its diagonal

    /// f [m].
    Vec3 shaped(const Vec3& p_DH, const Vec3& joints) const noexcept {
        if (arm) return model::phantom_position(*arm, joints + joint_offset);
        return p_DH + stretch * p_DH;
    }
    /// p' [m].
    Vec3 position(const Vec3& p_DH, const Vec3& joints) const noexcept {
        return X * shaped(p_DH, joints);
    }
    /// A. Where the arm is stretched or folded and has no inverse, R.
    Mat3 slope(const Vec3& joints) const noexcept;
};

}  // namespace dihaptic::rig
