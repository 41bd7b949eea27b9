// The gravity that people and devices live in.
#pragma once

namespace dihaptic::model {

constexpr double kGravity = 9.81;  // [m/s^2]

}  // namespace dihaptic::model
