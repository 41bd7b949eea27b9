#include "rig/device_reader.h"

#include <fmt/format.h>

#include <exception>
#include <thread>

namespace dihaptic::rig {

DeviceReader::DeviceReader(devices::DeviceGroup& devices, std::vector<std::string> fingers)
    : devices_(devices),
      fingers_(std::move(fingers)),
      readings_(fingers_.size()),
      none_(fingers_.size()) {}

void DeviceReader::tick(Time now) noexcept {
    devices_.read(now, readings_);
    devices_.write(none_);
}

void DeviceReader::check() const {
    for (size_t i = 0; i < readings_.size(); ++i) {
        const devices::Reading& reading = readings_[i];
        const bool silent = (reading.status & kNotAnswering) != 0;
        if (!silent && reading.p_DH.allFinite() && reading.joints.allFinite()) continue;
        throw Error(fmt::format("the {}'s device does not answer", fingers_[i]),
                    "Check its power and its cables, and start again.");
    }
}

void DeviceReader::repeat(const std::function<bool()>& each) {
    using Clock = std::chrono::steady_clock;
    std::exception_ptr failure;
    const auto once = [&] {
        try {
            if (devices_.active()) {
                tick(Clock::now() - begin_);
                check();
            }
            return each();
        } catch (...) {
            // exceptions must not pass through a manufacturer's library
            failure = std::current_exception();
            return false;
        }
    };
    if (devices_.active() && devices_.paces()) {
        devices_.pace(once);
    } else {
        auto due = Clock::now();
        while (once()) {
            due += kTick;
            std::this_thread::sleep_until(due);
        }
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace dihaptic::rig
