// Minimum-jerk movement (Flash and Hogan 1985): the smoothest path between two points at rest,
//
//     x(s) = x0 + (x1 - x0) (10 s^3 - 15 s^4 + 6 s^5),   s = t / T in [0, 1]
//
// The peak speed is 15/8 of the mean speed, and is reached at s = 1/2. If the two points are passed
// at the speeds v0 and v1, with zero acceleration, the smoothest path is the quintic
//
//     x(s) = x0 + (x1 - x0) (10 s^3 - 15 s^4 + 6 s^5)
//            + T v0 (s - 6 s^3 + 8 s^4 - 3 s^5) + T v1 (-4 s^3 + 7 s^4 - 3 s^5)
#pragma once

#include <algorithm>

namespace dihaptic::model {

/// Fraction of the path covered at s, and its first derivative with respect to s. Outside [0, 1],
/// the fraction is constant and the derivative is 0.
struct MinimumJerk {
    double share;
    double rate;
};

constexpr MinimumJerk minimum_jerk(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return {s * s * s * (10 + s * (6 * s - 15)), 30 * s * s * (1 - s) * (1 - s)};
}

/// Second derivative of the fraction with respect to s; 0 outside [0, 1].
constexpr double minimum_jerk_acceleration(double s) {
    if (s < 0 || s > 1) return 0;
    return 60 * s * (1 - s) * (1 - 2 * s);
}

/// Contributions of a unit speed at the start or at the end to the fraction, i.e. the factors of T
/// v0 and T v1 above, each with its derivative.
constexpr MinimumJerk start_speed_part(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return {s * (1 + s * s * (-6 + s * (8 - 3 * s))), 1 + s * s * (-18 + s * (32 - 15 * s))};
}
constexpr MinimumJerk end_speed_part(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return {s * s * s * (-4 + s * (7 - 3 * s)), s * s * (-12 + s * (28 - 15 * s))};
}

/// Ratio of the peak speed to the mean speed.
constexpr double kMinimumJerkPeak = 15.0 / 8.0;

}  // namespace dihaptic::model
