// What stands where nothing was measured.
#pragma once

#include <limits>

namespace dihaptic {

constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();

}  // namespace dihaptic
