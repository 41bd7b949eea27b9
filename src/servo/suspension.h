// For how long the machine was suspended. The monotonic clock stands still then, and by it a tick
// after hours of sleep would come in time, to hands that have long let go.
#pragma once

#include "base/clock.h"

namespace dihaptic::servo {

class Suspension {
  public:
    /// The clock that goes on, read between two readings of the one that does not.
    struct Clocks {
        Time before{0};
        Time boot{0};
        Time after{0};
    };
    static Clocks read() noexcept;

    explicit Suspension(const Clocks& clocks) : offset_(clocks.boot - clocks.before) {}

    /// Since this was asked last, or since the beginning; 0 when it was not. A thread that has to
    /// wait between two readings takes that for no suspension.
    Time since(const Clocks& clocks) noexcept {
        const Time least = clocks.boot - clocks.after - offset_;
        if (least < kLeast) return Time(0);
        offset_ += least;
        return least;
    }

  private:
    static constexpr Time kLeast = std::chrono::milliseconds(1);
    Time offset_;  // of the one clock over the other, at most so much
};

}  // namespace dihaptic::servo
