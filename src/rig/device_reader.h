// Devices that are only read: no force is ever written but zero.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "devices/device_group.h"

namespace dihaptic::rig {

class DeviceReader {
  public:
    /// How often devices are read that do not say it themselves.
    static constexpr Time kTick = std::chrono::milliseconds(1);

    /// `fingers`: who holds each, for what is said of one that does not answer.
    DeviceReader(devices::DeviceGroup& devices, std::vector<std::string> fingers);

    /// Reads once, at `now`.
    void tick(Time now) noexcept;
    /// In real time: reads, at the devices' own pace where they have one, and calls `each` after
    /// each reading until it returns false. Devices that are not active are not read. Throws Error
    /// when a device does not answer, and what `each` throws.
    void repeat(const std::function<bool()>& each);

    const std::vector<devices::Reading>& readings() const { return readings_; }

  private:
    void check() const;

    devices::DeviceGroup& devices_;
    std::vector<std::string> fingers_;
    std::vector<devices::Reading> readings_;
    std::vector<Wrench> none_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace dihaptic::rig
