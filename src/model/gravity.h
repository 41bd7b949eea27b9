// The gravitational acceleration used in models of people and devices.
#pragma once

namespace dihaptic::model {

constexpr double kGravity = 9.81;  // [m/s^2]

}  // namespace dihaptic::model
