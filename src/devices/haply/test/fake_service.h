// A fake Inverse Service: a WebSocket server in its own thread, with simulated devices behind it.
// On connection it sends a full inventory, then exactly one state message for each message from the
// client; most of these leave out the optional parts. A force lasts for one tick of the service; if
// no message arrives in a tick, the devices are idle.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/device_group.h"
#include "devices/test/fake_hand.h"

namespace dihaptic::devices::haply {

/// The kinds of misbehaviour that misbehave() can produce.
enum class Mischief {
    none,
    late,               ///< one answer is late by `pause`
    silent,             ///< from then on, it does not answer
    half_message,       ///< it stops in the middle of a message, and then stays silent
    half_json,          ///< from then on, its messages are complete, but the JSON in them is not
    not_a_number,       ///< one position is not a number
    leaves_out,         ///< from then on, one device is missing from its answers
    loses_calibration,  ///< one device reports that it is not calibrated
    complains,          ///< it answers with an error, and no longer obeys
    closes,             ///< it ends the connection, as at a restart, and accepts the next one
};

class FakeService {
  public:
    struct Setup {
        std::vector<DeviceConfig> devices;  ///< the poses and options of the simulated devices
        Hand hand;                          ///< moves the handles, in place of simulated devices
        std::vector<std::string> ids{"049D", "04A1", "04A2"};
        /// Tick rate on the real clock [Hz]. If 0, there is one tick per message, which is answered
        /// at once.
        double rate = 0;
        std::string refused_key;    ///< the name of the force field that the service refuses
        bool refuses_http = false;  ///< answers each handshake with 404
        bool garbage = false;       ///< answers a handshake with something other than HTTP
        bool grips =
            false;  ///< whether each device has a wireless grip "A<i>" that turns with the device
        std::string not_calibrated, not_ready, no_power;  ///< serial numbers
        std::string greeting;                             ///< text sent in place of the inventory
    };

    /// `context` says how the simulated devices are moved and, if no rate is given, how long a tick
    /// is.
    FakeService(const Setup& setup, const Context& context);
    ~FakeService();

    std::string url() const;
    /// The options that a rig file contains for one of the service's devices. `more` contains
    /// further options, such as "time_out_ms: 5, ".
    Node options(size_t device, const std::string& more = "") const;

    /// Makes the service misbehave once, starting with its answer to message number `message` of a
    /// connection, counted from 0.
    void misbehave(Mischief what, int message, size_t device = 0, Time pause = Time(0));

    using Forces = std::vector<Vec3>;  ///< one force for each device, in D [N]
    /// The forces in all messages with commands, from all connections, in the order in which they
    /// arrived.
    std::vector<Forces> received() const;
    /// The forces that the devices exerted in each tick.
    std::vector<Forces> felt() const;
    /// The tick in which the service misbehaved; -1 if it has not done so yet.
    int mischief_tick() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Configurations for two or more devices of the service, for use with make().
std::vector<DeviceConfig> rig_of(const FakeService& service,
                                 const std::vector<DeviceConfig>& simulated,
                                 const std::string& more = "");

}  // namespace dihaptic::devices::haply
