// Time since the session's activation, in whole nanoseconds: sums of ticks stay exact.
#pragma once

#include <chrono>

namespace dihaptic {

using Time = std::chrono::nanoseconds;

/// Seconds as a number, for arithmetic.
constexpr double seconds(Time time) {
    return std::chrono::duration<double>(time).count();
}

/// The nearest whole nanosecond to a number of seconds.
constexpr Time from_seconds(double s) {
    return Time(static_cast<Time::rep>(s * 1e9 + (s < 0 ? -0.5 : 0.5)));
}

}  // namespace dihaptic
