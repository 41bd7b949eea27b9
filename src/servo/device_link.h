// DeviceLink is the servo's side of the devices: it switches them on and off, holds what they last
// read, and sends the wrenches. The watchdog may stop the devices from another thread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "devices/device_group.h"
#include "frame/settings.h"
#include "scene/scene.h"

namespace dihaptic::servo {

class DeviceLink {
  public:
    /// Limits the devices' forces. They are ordered like `fingers`.
    DeviceLink(std::unique_ptr<devices::DeviceGroup> devices,
               const std::vector<scene::Finger>& fingers, const frame::SafetySettings& safety);
    ~DeviceLink();

    const devices::DeviceGroup& devices() const { return *devices_; }
    devices::DeviceGroup& devices() { return *devices_; }
    const frame::DeviceInfo& info(size_t finger) const {
        return devices_->info(static_cast<int>(finger));
    }

    /// Throws Error when the devices cannot be activated.
    void activate();
    /// Sends zero force, then switches the devices off.
    void deactivate();
    /// Switches the devices off and on again. Throws Error when they cannot be activated.
    void reactivate();
    void rest() noexcept;
    /// Switches force off on all devices at once. Returns false if the devices do not support this.
    /// May be called from any thread.
    bool stop() noexcept;
    /// Whether stop() has been called since this function was last called.
    bool take_stop() noexcept { return stopped_.exchange(false); }

    void read(Time now) noexcept { devices_->read(now, readings_); }
    const devices::Reading& reading(size_t finger) const { return readings_[finger]; }
    /// Whether any device has dropped its force.
    bool any_force_dropped() const noexcept;
    /// Whether the dead-man switch is held, or none is required.
    bool switch_held() const noexcept;
    /// Sets the wrench that the next write() sends, in the device's frame.
    void set(size_t finger, const Wrench& sent_D) noexcept { sent_D_[finger] = sent_D; }
    void write() noexcept { devices_->write(sent_D_); }

  private:
    std::unique_ptr<devices::DeviceGroup> devices_;
    std::vector<devices::Reading> readings_;
    std::vector<Wrench> sent_D_;
    bool needs_switch_;
    int switch_button_;
    int switch_finger_ = -1;  // index of the device with the dead-man switch; -1 if there is none
    bool active_ = false;
    std::atomic<bool> stopped_{false};
};

}  // namespace dihaptic::servo
