// What a procedure makes of the answers so far.
#pragma once

#include <limits>

namespace dihaptic::experiment {

/// In the unit of the level; NaN: not known.
struct Estimate {
    double threshold = std::numeric_limits<double>::quiet_NaN();
    /// 95 % interval.
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace dihaptic::experiment
