// A fake libHD. It behaves according to OpenHaptics' manuals, including faults, and a hand provided
// by the test moves its handles. Like the real library, it exists only once in a program; fake_hd()
// returns it.
#pragma once

#include <dlfcn.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "devices/test/fake_hand.h"

namespace dihaptic::devices::openhaptics {

struct FakeHd {
    struct Device {
        std::string name;
        std::string model = "PHANToM Premium 1.0";
        std::string serial;
        unsigned style = 1;             ///< calibration style: a sum of HdCalibrationStyle values
        unsigned calibration = 0x5000;  ///< HdCalibration
        unsigned updated = 0x5000;      ///< the HdCalibration state after an update
        int input_dof = 3;
        int output_dof = 3;
        double max_force = 8.5;                                ///< [N]
        double continuous_force = 1.4;                         ///< [N]
        double max_torque = -1;                                ///< [mN*m]; negative if not stated
        double continuous_torque = -1;                         ///< [mN*m]; negative if not stated
        double max_stiffness = 1;                              ///< [N/mm]
        double max_damping = 0.005;                            ///< [N*s/mm]
        double workspace[6] = {-127, -60, -40, 127, 118, 87};  ///< minima, then maxima [mm]
        /// True minus reported joint angles [rad], for a device whose positions are computed from
        /// the reported angles. If unset, the device reports no joint angles.
        std::optional<Vec3> joint_offset;
        bool nonsense = false;  ///< whether the device's position is not a number

        // the device's state
        int opened = 0;  ///< number of times that the device was initialised
        bool initialised = false;
        /// Whether it was initialised while the scheduler was running, so that it takes no part in
        /// it.
        bool late = false;
        bool force_enabled = false;
        bool ramping = false;
        int resets = 0;                     ///< number of encoder resets
        Vec3 acting = Vec3::Zero();         ///< force that acts on the hand [N]
        Vec3 acting_torque = Vec3::Zero();  ///< torque that acts on the hand [N*m]
        int frames = 0;
        int frames_of_force = 0;  ///< number of frames since its amplifiers were switched on
    };
    std::vector<Device> devices;
    Hand hand;              ///< if null, the handles do not move
    bool real_time = true;  ///< if false, runs as fast as the machine can
    double ramp = 50;       ///< rate at which force rises after it has been switched on [N/s]
    std::vector<unsigned long> rates{500, 1000, 2000, 4000};  ///< rates that can be chosen
    unsigned init_error = 0;                                  ///< error of the next hdInitDevice()
    bool silent = false;  ///< whether the scheduler stops calling callbacks
    /// Called by the scheduler before each tick, counted from 0. If it returns false, the scheduler
    /// stops calling callbacks.
    std::function<bool(int tick)> before_tick;
    /// Called in hdBeginFrame(), and may block.
    std::function<void(size_t device)> in_frame;
    int violations = 0;      ///< number of calls made that the manuals forbid
    int callbacks_left = 0;  ///< number of callbacks that are neither done nor unscheduled

    /// Pushes an error of a device onto the error stack. A force error also removes the device's
    /// force at once.
    std::function<void(unsigned code, size_t device)> raise;
    /// Resets the library to a state with the two devices of the 2012 rig.
    std::function<void()> reset;
};

#if __has_include("fake_makers.h")  // this header is absent when the fake library itself is built
#include "fake_makers.h"
/// Returns the fake library of this program in its present state, whereas fake_hd() resets it.
inline FakeHd& fake_hd_as_it_is() {
    void* const library = dlopen(DIHAPTIC_FAKE_HD, RTLD_LAZY | RTLD_GLOBAL);
    if (library == nullptr) throw std::runtime_error(dlerror());
    return *reinterpret_cast<FakeHd* (*)()>(dlsym(library, "dihaptic_fake_hd"))();
}
inline FakeHd& fake_hd() {
    FakeHd& fake = fake_hd_as_it_is();
    fake.reset();
    fake.real_time = false;
    return fake;
}
#endif

}  // namespace dihaptic::devices::openhaptics
