// What moves the handles of the makers' fake libraries: a test's function, or nothing.
#pragma once

#include <functional>

#include "base/geometry.h"

namespace dihaptic::devices {

/// State of a handle, in its device's frame D.
struct Held {
    Vec3 p = Vec3::Zero();      ///< [m]
    Vec3 v = Vec3::Zero();      ///< [m/s]
    Quat R = Quat::Identity();  ///< from its neutral orientation
    Vec3 w = Vec3::Zero();      ///< [rad/s]
};

/// State of device i at time t [s] from when it was first asked for; since it was last asked for,
/// the device has pushed and turned it with `push`.
using Hand = std::function<Held(size_t i, double t, const Wrench& push)>;

}  // namespace dihaptic::devices
