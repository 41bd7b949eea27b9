// The gravitational acceleration that models of people and devices use.
#pragma once

namespace dihaptic::model {

constexpr double kGravity = 9.81;  // [m/s^2]

}  // namespace dihaptic::model
