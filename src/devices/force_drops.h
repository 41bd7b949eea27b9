// Distinguishes a single drop in a device's force from a fault. Devices cut their own force when
// too much is requested, and restore it later. A single drop is treated as an event; repeated drops
// are treated as a fault, because without a message a person would think that the simulated world
// is broken.
#pragma once

#include <optional>

#include "devices/device_group.h"

namespace dihaptic::devices {

class ForceDrops {
  public:
    /// Drops farther apart than this are separate events.
    static constexpr Time kApart = std::chrono::seconds(1);
    static constexpr Time kLongest = std::chrono::seconds(2);  ///< a longer series is a fault

    /// Returns the Status of a tick at `now`; `dropped` says whether force was cut in that tick.
    uint32_t status(Time now, bool dropped) noexcept {
        if (!dropped) return 0;
        if (!first_ || now - last_ > kApart) first_ = now;
        last_ = now;
        return now - *first_ > kLongest ? kDeviceFault : kForceDropped;
    }
    void reset() noexcept { first_.reset(); }

  private:
    std::optional<Time> first_;
    Time last_{0};
};

}  // namespace dihaptic::devices
