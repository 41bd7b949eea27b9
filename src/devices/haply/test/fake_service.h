// Stands for the Inverse Service: a WebSocket server in a thread of its own, with simulated devices
// behind it. A full inventory on connect, then exactly one state message for each of the client's;
// parts that need not be there are left out most of the time. A force lasts one tick of the
// service; without a message in a tick the devices are idle.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/device_group.h"
#include "devices/test/fake_hand.h"

namespace dihaptic::devices::haply {

/// What it does wrong, once it is asked to.
enum class Mischief {
    none,
    late,               ///< one answer comes `pause` late
    silent,             ///< it answers no more
    half_message,       ///< it stops in the middle of a message, and is silent
    half_json,          ///< from then on its messages are whole, but not what is in them
    not_a_number,       ///< one position is none
    leaves_out,         ///< one device is not in its answers any more
    loses_calibration,  ///< one device says that it is not calibrated
    complains,          ///< it answers with an error, and obeys no more
    closes,             ///< it ends the connection, as when it restarts; the next one is served
};

class FakeService {
  public:
    struct Setup {
        std::vector<DeviceConfig> devices;  ///< X_WD and the options of simulated devices
        Hand hand;  ///< that moves the handles, in place of simulated devices
        std::vector<std::string> ids{"049D", "04A1", "04A2"};
        /// Ticks on the real clock [Hz]. 0: a tick for each message, answered at once.
        double rate = 0;
        std::string refused_key;    ///< spelling of the force's field that it does not know
        bool refuses_http = false;  ///< 404 to each handshake
        bool garbage = false;       ///< answers a handshake with what is no HTTP
        bool grips = false;         ///< a wireless grip "A<i>" for each device, which turns with it
        std::string not_calibrated, not_ready, no_power;  ///< serials
        std::string greeting;                             ///< in place of the inventory
    };

    /// `context` says how the simulated devices are moved, and how long a tick without a rate is.
    FakeService(const Setup& setup, const Context& context);
    ~FakeService();

    std::string url() const;
    /// Options of the rig file for one of its devices; `more` as in "time_out_ms: 5, ".
    Node options(size_t device, const std::string& more = "") const;

    /// From the answer to the n-th message of a connection, from 0; once.
    void misbehave(Mischief what, int message, size_t device = 0, Time pause = Time(0));

    using Forces = std::vector<Vec3>;  ///< by device, in D [N]
    /// Of each message with commands, in the order in which they came, of all connections.
    std::vector<Forces> received() const;
    /// What the devices did in each tick.
    std::vector<Forces> felt() const;
    /// The tick in which it misbehaved; -1: it did not yet.
    int mischief_tick() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The options of two or more devices for make().
std::vector<DeviceConfig> rig_of(const FakeService& service,
                                 const std::vector<DeviceConfig>& simulated,
                                 const std::string& more = "");

}  // namespace dihaptic::devices::haply
