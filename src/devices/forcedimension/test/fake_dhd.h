// A fake libdhd. It behaves according to Force Dimension's documentation, including faults, and a
// hand provided by the test moves its handles. Like the real library, it exists only once in a
// program; fake_dhd() returns it. Its time advances by one period with each reading. When a whole
// program is tested and DIHAPTIC_FAKE_PUSH moves the handles, it uses real time.
#pragma once

#include <dlfcn.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "devices/test/fake_hand.h"

namespace dihaptic::devices::forcedimension {

struct FakeDhd {
    struct Device {
        std::string model = "omega.3";
        unsigned short serial = 0;
        double max_force = 12;      ///< [N]; negative if not stated
        double max_torque = -1;     ///< [N*m]; negative if not stated
        bool wrist = false;         ///< measures orientation
        bool active_wrist = false;  ///< renders torque
        bool has_watchdog = true;   ///< whether there is one; it acts only if it was set
        bool in_use = false;        ///< whether another program uses the device
        bool power = true;
        bool connected = true;
        bool calibrated = true;
        bool broken = false;
        bool silent = false;      ///< whether every call for the device fails
        bool nonsense = false;    ///< whether the device's position is not a number
        bool time_guard = false;  ///< whether dhdGetPosition() returns 1
        double fastest = 0;       ///< velocity threshold of the device; 0 if it has none [m/s]

        // the device's state
        int opened = 0;  ///< number of times that the device was opened
        bool open = false;
        bool force_enabled = false;
        bool gravity = false;
        int cause = 0;  ///< DhdForceOff
        int frames = 0;
        unsigned char watchdog = 0;         ///< number of steps of 125 us; 0 if it is switched off
        double told_at = 0;                 ///< time of its last force command, on its clock [s]
        Vec3 wanted = Vec3::Zero();         ///< last commanded force [N]
        Vec3 acting = Vec3::Zero();         ///< force that acts on the hand [N]
        Vec3 acting_torque = Vec3::Zero();  ///< torque that acts on the hand [N*m]
    };
    std::vector<Device> devices;
    Hand hand;             ///< if null, the handles do not move
    double period = 1e-3;  ///< time between two readings [s]
    bool expert = false;   ///< whether expert mode, which setting a watchdog requires, is on
    /// Called at the start of dhdGetPosition(); may block.
    std::function<void(size_t device)> in_position;

    /// Makes a device cut its force; `cause` is a DhdForceOff value.
    std::function<void(size_t device, int cause)> cut;
    /// Resets the library to a state with two omega.3 devices connected.
    std::function<void()> reset;
};

#if __has_include("fake_makers.h")  // this header is absent when the fake library itself is built
#include "fake_makers.h"
/// Returns the fake library of this program in its present state, whereas fake_dhd() resets it.
inline FakeDhd& fake_dhd_as_it_is() {
    void* const library = dlopen(DIHAPTIC_FAKE_DHD, RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error(dlerror());
    return *reinterpret_cast<FakeDhd* (*)()>(dlsym(library, "dihaptic_fake_dhd"))();
}
inline FakeDhd& fake_dhd() {
    FakeDhd& fake = fake_dhd_as_it_is();
    fake.reset();
    return fake;
}
#endif

}  // namespace dihaptic::devices::forcedimension
