// Data shared by the manufacturers' fake libraries and a test in another process. The test runs and
// kills the whole program, and checks whether a device still pushes the hand.
//
// DIHAPTIC_FAKE_FELT names a memory-mapped file that contains a Felt for each device. The data that
// a process leaves there when it dies show what its devices would continue to do.
// DIHAPTIC_FAKE_PUSH is "x y z": the position to which the handles go from D's origin within half a
// second, and where they stay [m]. DIHAPTIC_FAKE_FAILS is e.g. "hangs 2" or "crashes 2": the
// library hangs or crashes 2 s after its first reading.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>

#include "devices/test/fake_hand.h"

namespace dihaptic::devices {

struct Felt {
    double force = 0;     ///< force that acts on the hand [N]
    double told_at = 0;   ///< time of the last force command, on CLOCK_MONOTONIC [s]
    double watchdog = 0;  ///< the firmware ends the force after this time; 0 if never [s]
    double gone_at = 0;   ///< time at which the force last became zero, on CLOCK_MONOTONIC [s]
    double opened = 0;    ///< number of times that the device was opened
};

class FeltOutside {
  public:
    static constexpr size_t kDevices = 8;

    FeltOutside() {
        const char* const file = std::getenv("DIHAPTIC_FAKE_FELT");
        if (file == nullptr) return;
        const int fd = open(file, O_RDWR | O_CREAT, 0600);
        if (fd < 0 || ftruncate(fd, sizeof(Felt) * kDevices) != 0) return;
        void* const at =
            mmap(nullptr, sizeof(Felt) * kDevices, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
        close(fd);
        if (at != MAP_FAILED) felt_ = static_cast<Felt*>(at);
    }

    /// Shows the force that acts. `told` says whether the device has just received a force command.
    void show(size_t device, const Vec3& force, bool told) noexcept {
        if (felt_ == nullptr || device >= kDevices) return;
        Felt& felt = felt_[device];
        const double now =
            std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
                .count();
        const double size = force.norm();
        if (size == 0 && felt.force != 0) felt.gone_at = now;
        felt.force = size;
        if (told) felt.told_at = now;
    }
    void note_opened(size_t device) noexcept {
        if (felt_ != nullptr && device < kDevices) ++felt_[device].opened;
    }
    void set_watchdog(size_t device, double seconds) noexcept {
        if (felt_ != nullptr && device < kDevices) felt_[device].watchdog = seconds;
    }

  private:
    Felt* felt_ = nullptr;
};

/// Called with each reading; makes the library fail as DIHAPTIC_FAKE_FAILS requests.
inline void fail_as_asked() {
    static const char* const text = std::getenv("DIHAPTIC_FAKE_FAILS");
    if (text == nullptr) return;
    using Clock = std::chrono::steady_clock;
    static const auto begin = Clock::now();
    std::string what;
    double after = 0;
    std::istringstream(text) >> what >> after;
    if (std::chrono::duration<double>(Clock::now() - begin).count() < after) return;
    if (what == "crashes") std::abort();
    while (what == "hangs") pause();
}

/// The hand that DIHAPTIC_FAKE_PUSH describes; null if the variable is not set.
inline Hand pushing_hand() {
    const char* const text = std::getenv("DIHAPTIC_FAKE_PUSH");
    if (text == nullptr) return {};
    Vec3 goal = Vec3::Zero();
    std::istringstream(text) >> goal.x() >> goal.y() >> goal.z();
    return [goal](size_t, double t, const Wrench&) {
        constexpr double kTime = 0.5;  // duration of the movement [s]
        Held out;
        out.p = std::min(t / kTime, 1.0) * goal;
        if (t < kTime) out.v = goal / kTime;
        return out;
    };
}

}  // namespace dihaptic::devices
