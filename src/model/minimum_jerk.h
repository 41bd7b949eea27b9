// Minimum-jerk movement (Flash and Hogan 1985): the smoothest path between two points at rest,
//
//     x(s) = x0 + (x1 - x0) (10 s^3 - 15 s^4 + 6 s^5),   s = t / T in [0, 1]
//
// Peak speed is 15/8 of the mean speed, at s = 1/2.
#pragma once

#include <algorithm>

namespace dihaptic::model {

/// Share of the way done at s, and its first derivative by s. Both are constant outside [0, 1].
struct MinimumJerk {
    double share;
    double rate;
};

constexpr MinimumJerk minimum_jerk(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return {s * s * s * (10 + s * (6 * s - 15)), 30 * s * s * (1 - s) * (1 - s)};
}

/// Peak speed over mean speed.
constexpr double kMinimumJerkPeak = 15.0 / 8.0;

}  // namespace dihaptic::model
