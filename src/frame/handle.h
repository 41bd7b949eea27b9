// The state of a device's handle, as read from the device.
#pragma once

#include "base/geometry.h"

namespace dihaptic::frame {

/// A device's measurements at its endpoint, in world coordinates.
struct Handle {
    Vec3 p_WH = Vec3::Zero();  ///< [m]
    Vec3 v_WH = Vec3::Zero();  ///< [m/s]
    /// Rotation of the handle from the device's neutral orientation, and angular velocity of the
    /// handle [rad/s]; identity and zero if the device does not measure orientation.
    Quat R_WH = Quat::Identity();
    Vec3 w_WH = Vec3::Zero();
};

/// Whether two readings are identical, i.e. the device repeats its last reading.
inline bool same(const Handle& a, const Handle& b) noexcept {
    return a.p_WH == b.p_WH && a.v_WH == b.v_WH && a.R_WH.coeffs() == b.R_WH.coeffs() &&
           a.w_WH == b.w_WH;
}

}  // namespace dihaptic::frame
