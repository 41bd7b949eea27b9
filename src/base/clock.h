// Time since the session's activation is counted in whole nanoseconds, so that sums of ticks stay
// exact.
#pragma once

#include <chrono>

namespace dihaptic {

using Time = std::chrono::nanoseconds;

/// A time in seconds, for arithmetic.
constexpr double seconds(Time time) {
    return std::chrono::duration<double>(time).count();
}

/// A number of seconds, rounded to the nearest whole nanosecond.
constexpr Time from_seconds(double s) {
    return Time(static_cast<Time::rep>(s * 1e9 + (s < 0 ? -0.5 : 0.5)));
}

}  // namespace dihaptic
