// The estimate of a threshold that a procedure makes from the answers so far.
#pragma once

#include <limits>

namespace dihaptic::task {

/// Values in the unit of the level; NaN if unknown.
struct Estimate {
    double threshold = std::numeric_limits<double>::quiet_NaN();
    /// Ends of the 95 % interval.
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace dihaptic::task
