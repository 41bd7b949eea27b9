// A fake Inverse Service: a WebSocket server in its own thread, with simulated devices behind
// it. It sends a full inventory on connect, then exactly one state message for each of the
// client's; optional parts are left out most of the time. A force lasts one tick of the service;
// without a message in a tick the devices are idle.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/device_group.h"
#include "devices/test/fake_hand.h"

namespace dihaptic::devices::haply {

/// The kinds of misbehaviour for misbehave().
enum class Mischief {
    none,
    late,               ///< one answer is late by `pause`
    silent,             ///< it no longer answers
    half_message,       ///< it stops in the middle of a message, and is silent
    half_json,          ///< from then on its messages are complete, but their JSON is not
    not_a_number,       ///< one position is not a number
    leaves_out,         ///< one device is missing from its answers from then on
    loses_calibration,  ///< one device reports that it is not calibrated
    complains,          ///< it answers with an error and no longer obeys
    closes,             ///< it ends the connection, as at a restart, and serves the next one
};

class FakeService {
  public:
    struct Setup {
        std::vector<DeviceConfig> devices;  ///< X_WD and the options of simulated devices
        Hand hand;                          ///< moves the handles, in place of simulated devices
        std::vector<std::string> ids{"049D", "04A1", "04A2"};
        /// Rate of ticks on the real clock [Hz]. 0: a tick for each message, answered at once.
        double rate = 0;
        std::string refused_key;    ///< spelling of the force's field that it refuses
        bool refuses_http = false;  ///< answers each handshake with 404
        bool garbage = false;       ///< answers a handshake with something other than HTTP
        bool grips =
            false;  ///< a wireless grip "A<i>" for each device, which turns with the device
        std::string not_calibrated, not_ready, no_power;  ///< serial numbers
        std::string greeting;                             ///< sent in place of the inventory
    };

    /// `context`: how the simulated devices are moved, and the length of a tick without a rate.
    FakeService(const Setup& setup, const Context& context);
    ~FakeService();

    std::string url() const;
    /// The rig file's options for one of its devices; `more`: further options, such as
    /// "time_out_ms: 5, ".
    Node options(size_t device, const std::string& more = "") const;

    /// Misbehaves once, starting with the answer to message number `message` of a connection, from
    /// 0.
    void misbehave(Mischief what, int message, size_t device = 0, Time pause = Time(0));

    using Forces = std::vector<Vec3>;  ///< by device, in D [N]
    /// The forces of each message with commands, of all connections, in the order of arrival.
    std::vector<Forces> received() const;
    /// The forces of the devices in each tick.
    std::vector<Forces> felt() const;
    /// The tick in which it misbehaved; -1: none yet.
    int mischief_tick() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Configurations of two or more devices of the service, for make().
std::vector<DeviceConfig> rig_of(const FakeService& service,
                                 const std::vector<DeviceConfig>& simulated,
                                 const std::string& more = "");

}  // namespace dihaptic::devices::haply
