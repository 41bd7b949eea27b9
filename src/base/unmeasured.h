// The value that stands for "not measured".
#pragma once

#include <limits>

namespace dihaptic {

constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();

}  // namespace dihaptic
