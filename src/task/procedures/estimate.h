// A procedure's estimate of a threshold from the answers so far.
#pragma once

#include <limits>

namespace dihaptic::task {

/// An estimate in the unit of the level. Values are NaN if unknown.
struct Estimate {
    double threshold = std::numeric_limits<double>::quiet_NaN();
    /// Lower and upper ends of the 95 % interval.
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace dihaptic::task
