// Reads devices with force off: it never writes a force other than zero.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "devices/device_group.h"

namespace dihaptic::rig {

class DeviceReader {
  public:
    /// Time between two readings of devices that do not pace.
    static constexpr Time kTick = std::chrono::milliseconds(1);

    /// `fingers` are the fingers that hold the devices; errors name them.
    DeviceReader(devices::DeviceGroup& devices, std::vector<std::string> fingers);

    /// Reads the devices once, at time `now`.
    void tick(Time now) noexcept;
    /// Reads in real time, at the devices' own pace if they pace, and calls `each` after each
    /// reading until it returns false. Devices that are not active are not read. Throws Error if a
    /// device does not answer, and passes on exceptions from `each`.
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
