// The hand that moves the handles of the manufacturers' fake libraries: a test's function, or none.
#pragma once

#include <functional>

#include "base/geometry.h"

namespace dihaptic::devices {

/// State of a handle, in its device's frame D.
struct Held {
    Vec3 p = Vec3::Zero();      ///< [m]
    Vec3 v = Vec3::Zero();      ///< [m/s]
    Quat R = Quat::Identity();  ///< rotation from its neutral orientation
    Vec3 w = Vec3::Zero();      ///< [rad/s]
};

/// The state of device i's handle at time t [s], from the first call on. `push`: the device's
/// wrench on it since the last call.
using Hand = std::function<Held(size_t i, double t, const Wrench& push)>;

}  // namespace dihaptic::devices
