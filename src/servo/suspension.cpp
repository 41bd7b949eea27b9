#include "servo/suspension.h"

#include <ctime>

namespace dihaptic::servo {
namespace {

Time read_clock(clockid_t clock) noexcept {
    timespec now{};
    clock_gettime(clock, &now);
    return std::chrono::seconds(now.tv_sec) + Time(now.tv_nsec);
}

}  // namespace

Suspension::Clocks Suspension::read() noexcept {
    Clocks out;
    out.before = read_clock(CLOCK_MONOTONIC);
    out.boot = read_clock(CLOCK_BOOTTIME);
    out.after = read_clock(CLOCK_MONOTONIC);
    return out;
}

}  // namespace dihaptic::servo
