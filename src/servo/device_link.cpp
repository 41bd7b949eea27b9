#include "servo/device_link.h"

#include <algorithm>
#include <utility>

namespace dihaptic::servo {

DeviceLink::DeviceLink(std::unique_ptr<devices::DeviceGroup> devices,
                       const std::vector<scene::Finger>& fingers,
                       const frame::SafetySettings& safety)
    : devices_(std::move(devices)),
      readings_(fingers.size()),
      sent_D_(fingers.size()),
      needs_switch_(!safety.dead_man_finger.empty()),
      switch_button_(safety.dead_man_button) {
    for (size_t i = 0; i < fingers.size(); ++i) {
        const int device = static_cast<int>(i);
        devices_->limit(device, safety.largest_force(info(i).peak_force, info(i).scale),
                        safety.largest_torque(info(i).peak_torque));
        if (fingers[i].name == safety.dead_man_finger) switch_finger_ = device;
    }
}

DeviceLink::~DeviceLink() {
    deactivate();
}

void DeviceLink::activate() {
    devices_->activate();
    active_ = true;
}

void DeviceLink::deactivate() {
    if (!active_) return;
    rest();
    devices_->deactivate();
    active_ = false;
}

void DeviceLink::reactivate() {
    devices_->deactivate();
    active_ = false;
    activate();
}

void DeviceLink::rest() noexcept {
    std::fill(sent_D_.begin(), sent_D_.end(), Wrench{});
    write();
}

bool DeviceLink::stop() noexcept {
    stopped_ = true;
    return devices_->can_stop() && devices_->stop();
}

bool DeviceLink::any_force_dropped() const noexcept {
    return std::any_of(readings_.begin(), readings_.end(), [](const devices::Reading& reading) {
        return (reading.status & kForceDropped) != 0;
    });
}

bool DeviceLink::switch_held() const noexcept {
    if (!needs_switch_) return true;
    if (switch_finger_ < 0) return false;  // without a switch, it counts as not held
    const devices::Reading& reading = readings_[static_cast<size_t>(switch_finger_)];
    return (reading.buttons >> switch_button_ & 1u) != 0;
}

}  // namespace dihaptic::servo
