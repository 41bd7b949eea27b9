// Detects faults that switch force off on every device, at once and regardless of the slew limit,
// until the session is explicitly resumed. A hand that was released must not be seized again
// unexpectedly.
//
// Each tick calls its HandleGuards first, before a reading that may be wrong is used in any
// computation.
#pragma once

#include <string>

#include "base/clock.h"
#include "base/status.h"
#include "haptics/coupling.h"

namespace dihaptic::haptics {

using dihaptic::FaultKind;

/// The first fault of a session, with its kind, device and time.
struct Fault {
    FaultKind kind = FaultKind::none;
    int device = -1;   ///< -1 for all devices
    Time time{0};      ///< time of the tick since activation
    double value = 0;  ///< measured value, in the unit used by describe()
    double limit = 0;  ///< limit for that value; for keeps_late, a stiffness [N/m]

    explicit operator bool() const { return kind != FaultKind::none; }
};

/// Describes a fault in one sentence, with a remedy for its cause. How the session continues is
/// left to the caller. `finger` held the device, whose type is `model`.
std::string describe(const Fault& fault, const std::string& finger, const std::string& model);

/// Keeps the first fault, since later ones are its consequences.
class FaultLatch {
  public:
    void trip(const Fault& fault) noexcept {
        if (!tripped()) fault_ = fault;
    }
    const Fault& fault() const noexcept { return fault_; }
    bool tripped() const noexcept { return static_cast<bool>(fault_); }

  private:
    Fault fault_;
};

/// Largest plausible speed at which a hand turns its handle [rad/s].
constexpr double kMostTurning = 100;

/// Decides whether a reading of one device can be used, by comparing it with the last reading:
///
///     |v_WH| <= max_speed   and   |p_WH - p_WH,old| <= max_speed * (t - t_old)
///
/// and likewise for rotations, with kMostTurning. The second condition detects a jump in position,
/// whatever velocity is reported. Once a device has failed, it is not trusted again: its handle
/// stays at rest where it last was, so that neither NaN nor a blow reaches the world being
/// recorded.
class HandleGuard {
  public:
    /// `max_speed` is the largest plausible speed of a hand [m/s].
    explicit HandleGuard(double max_speed) : max_speed_(max_speed) {}

    /// Returns a usable handle. `read` is the measured state, `reported` the fault that the device
    /// itself reports, and `elapsed` the time since the last call [s]. If the reading cannot be
    /// used, `fault` is set to the reason.
    frame::Handle accept(const frame::Handle& read, FaultKind reported, double elapsed,
                         Fault& fault) noexcept;

  private:
    double max_speed_;
    frame::Handle last_;
    bool seen_ = false;
    bool trusted_ = true;
};

}  // namespace dihaptic::haptics
