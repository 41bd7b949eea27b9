// A device has one owner at a time: two programs that write forces to one device would each believe
// that theirs acts. Who activates a real device claims it by its backend and serial number; the
// kernel gives the claim back when the owner ends, however that ends.
//
// A claim is an abstract UNIX socket of that name. It is the machine's, whoever the user is, needs
// no file that could be left behind or replaced, and says whose it is. Another user could claim a
// device that they do not have, as they could open it: the message names them.
#pragma once

#include <string>
#include <vector>

#include "base/clock.h"
#include "devices/device_group.h"

namespace dihaptic::devices {

class DeviceClaim {
  public:
    /// Waits for `patience`, as a session that ends may close its devices still. Throws Error for
    /// `place` when another owner has it then. `info`: of an open device.
    DeviceClaim(const std::string& backend, const frame::DeviceInfo& info, const Place& place,
                Time patience);
    ~DeviceClaim();
    DeviceClaim(DeviceClaim&& other) noexcept;
    DeviceClaim& operator=(DeviceClaim&&) = delete;

  private:
    int socket_ = -1;
};

/// Claims all of a group's devices. Simulated ones need no claim: nothing is returned for them.
std::vector<DeviceClaim> claim_devices(const std::string& backend, const DeviceGroup& devices,
                                       const std::vector<Place>& places);

}  // namespace dihaptic::devices
