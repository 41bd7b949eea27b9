// The hand that moves the handles of the manufacturers' fake libraries. It is a function provided
// by the test, or null.
#pragma once

#include <functional>

#include "base/geometry.h"

namespace dihaptic::devices {

/// State of a handle, in the frame D of its device.
struct Held {
    Vec3 p = Vec3::Zero();      ///< [m]
    Vec3 v = Vec3::Zero();      ///< [m/s]
    Quat R = Quat::Identity();  ///< rotation from the handle's neutral orientation
    Vec3 w = Vec3::Zero();      ///< [rad/s]
};

/// Returns the state of device i's handle at time t [s], counted from the first call. `push` is the
/// wrench that the device has exerted on the handle since the last call.
using Hand = std::function<Held(size_t i, double t, const Wrench& push)>;

}  // namespace dihaptic::devices
