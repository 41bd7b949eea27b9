// A device has only one owner at a time. If two programs sent forces to the same device, each would
// assume that its own force acts. A program that activates a real device claims it by its backend
// and serial number; the kernel releases the claim when the owner ends, whatever the reason.
//
// A claim is an abstract UNIX socket named after the backend and the serial number. It applies to
// all users of the machine, needs no file that could be left behind or replaced, and reveals its
// owner. Another user could claim a device without using it, just as they could open it, but the
// error message names that user.
#pragma once

#include <string>
#include <vector>

#include "base/clock.h"
#include "base/descriptor.h"
#include "devices/device_group.h"

namespace dihaptic::devices {

class DeviceClaim {
  public:
    /// Claims a device. Waits for up to `patience`, because a session that is ending may still be
    /// closing its devices. Throws Error at `place` if another owner still holds the device after
    /// that. `info` is the information of the open device.
    DeviceClaim(const std::string& backend, const frame::DeviceInfo& info, const Place& place,
                Time patience);

  private:
    Descriptor socket_;
};

/// Claims all devices of a group. Simulated devices need no claim, so the result is empty for them.
std::vector<DeviceClaim> claim_devices(const std::string& backend, const DeviceGroup& devices,
                                       const std::vector<Place>& places);

}  // namespace dihaptic::devices
