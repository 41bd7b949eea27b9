// A device has one owner at a time. If two programs wrote forces to one device, each would assume
// that its own force acts. A program that activates a real device claims it by its backend and
// serial number; the kernel releases the claim when the owner ends, for any reason.
//
// A claim is an abstract UNIX socket named after both. It is valid for all users of the machine,
// needs no file that could be left behind or replaced, and reveals its owner. Another user could
// claim a device without using it, just as they could open it; the message names them.
#pragma once

#include <string>
#include <vector>

#include "base/clock.h"
#include "base/descriptor.h"
#include "devices/device_group.h"

namespace dihaptic::devices {

class DeviceClaim {
  public:
    /// Waits for up to `patience`, because a session that is ending may still be closing its
    /// devices. Throws Error for `place` if another owner still holds the device after that.
    /// `info`: that of an open device.
    DeviceClaim(const std::string& backend, const frame::DeviceInfo& info, const Place& place,
                Time patience);

  private:
    Descriptor socket_;
};

/// Claims all of a group's devices. Simulated devices need no claim, so nothing is returned for
/// them.
std::vector<DeviceClaim> claim_devices(const std::string& backend, const DeviceGroup& devices,
                                       const std::vector<Place>& places);

}  // namespace dihaptic::devices
