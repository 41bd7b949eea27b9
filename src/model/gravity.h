// The gravitational acceleration at which people and devices are modelled.
#pragma once

namespace dihaptic::model {

constexpr double kGravity = 9.81;  // [m/s^2]

}  // namespace dihaptic::model
