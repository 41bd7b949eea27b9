// A libdhd of our own: it behaves as Force Dimension's documentation says, its faults included, and
// moves its handles by a test's hand. As the real one it exists once in a program; fake_dhd() finds
// it. Its time is that of its readings, a period each; of a whole program, which
// DIHAPTIC_FAKE_PUSH moves, it is the real one.
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
        double max_force = 12;      ///< [N]; negative: it does not say
        double max_torque = -1;     ///< [N*m]; the same
        bool wrist = false;         ///< measures orientation
        bool active_wrist = false;  ///< renders torque
        bool has_watchdog = true;   ///< of firmware that has one: it acts only when it was set
        bool in_use = false;        ///< by another program
        bool power = true;
        bool connected = true;
        bool calibrated = true;
        bool broken = false;
        bool silent = false;      ///< every call about it fails
        bool nonsense = false;    ///< its position is not a number
        bool time_guard = false;  ///< dhdGetPosition() returns 1
        double fastest = 0;       ///< its velocity threshold; 0: none [m/s]

        // what became of it
        bool open = false;
        bool force_enabled = false;
        bool gravity = false;
        int cause = 0;  ///< DhdForceOff
        int frames = 0;
        unsigned char watchdog = 0;         ///< steps of 125 us; 0: none
        double told_at = 0;                 ///< a force, in its time [s]
        Vec3 wanted = Vec3::Zero();         ///< as it was last told [N]
        Vec3 acting = Vec3::Zero();         ///< what pushes the hand [N]
        Vec3 acting_torque = Vec3::Zero();  ///< and turns it [N*m]
    };
    std::vector<Device> devices;
    Hand hand;             ///< none: the handles stay where they are
    double period = 1e-3;  ///< [s]
    bool expert = false;   ///< mode, in which a watchdog may be set
    /// Called at the beginning of dhdGetPosition(): may block.
    std::function<void(size_t device)> in_position;

    /// A device cuts its force; `cause` is a DhdForceOff.
    std::function<void(size_t device, int cause)> cut;
    /// Anew, with two omega.3.
    std::function<void()> reset;
};

#if __has_include("fake_makers.h")  // not where the library itself is built
#include "fake_makers.h"
/// The one in this program, as it is; and made anew.
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
