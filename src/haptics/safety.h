// What switches force off. A fault ends it on every device at once, exempt from the slew limit, and
// until somebody says that the session goes on: a person who was let go must not be seized again
// unawares.
//
// A tick asks its HandleGuards first, before anything is computed from a reading that may be wrong.
#pragma once

#include <string>

#include "base/clock.h"
#include "haptics/coupling.h"

namespace dihaptic::haptics {

enum class FaultKind {
    none,
    bad_reading,      ///< a position or velocity that is not a number
    not_answering,    ///< the device says nothing
    uncalibrated,     ///< the device lost its calibration
    device_fault,     ///< the device reports that something in it is broken
    too_fast,         ///< the handle moved faster than `max_speed`, or jumped
    turned_too_fast,  ///< or turned faster than kMostTurning
    late,             ///< no force was computed for longer than `max_pause`, or `max_late`
    keeps_late,       ///< so many ticks were late that the loop holds nothing any more
    not_finite,       ///< the force that was computed is not a number
    diverged,         ///< the place or the speed of something in the world is not a number
    active,           ///< a coupling went on feeding energy into a hand
    chatters,         ///< a force went on alternating from tick to tick
    abandoned,        ///< whoever watches the session, a window, does not answer any more
    stopped,          ///< the operator switched force off
};

/// The first fault of a session: what, which device, when.
struct Fault {
    FaultKind kind = FaultKind::none;
    int device = -1;   ///< -1: all of them
    Time time{0};      ///< of the tick, from activation
    double value = 0;  ///< what was measured, in the unit that describe() says
    double limit = 0;  ///< by which it is a fault; of keeps_late a stiffness [N/m]

    explicit operator bool() const { return kind != FaultKind::none; }
};

/// One sentence, and what to do about the cause; how the session goes on is whoever runs it to say.
/// `finger` held the device, a `model`.
std::string describe(const Fault& fault, const std::string& finger, const std::string& model);

/// Keeps the first fault: those after it are its consequences.
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

/// Largest plausible speed at which a hand turns a handle [rad/s].
constexpr double kMostTurning = 100;

/// Decides whether one device's readings can be used, from each and the one before:
///
///     |v_WH| <= max_speed   and   |p_WH - p_WH,old| <= max_speed * (t - t_old)
///
/// and the same for turning, with kMostTurning. The second finds a position that jumps, whatever
/// velocity comes with it. A device that failed once is not trusted again: its handle then stays
/// where it last was, at rest, so that neither NaN nor a blow reaches the world that is being
/// recorded.
class HandleGuard {
  public:
    /// Largest plausible speed of a hand [m/s].
    explicit HandleGuard(double max_speed) : max_speed_(max_speed) {}

    /// The handle to work with. `read` is as measured, `reported` what the device says is wrong
    /// with it, `elapsed` the time since the last call [s]; when the reading cannot be used,
    /// `fault` gets why.
    Handle accept(const Handle& read, FaultKind reported, double elapsed, Fault& fault) noexcept;

  private:
    double max_speed_;
    Handle last_;
    bool seen_ = false;
    bool trusted_ = true;
};

}  // namespace dihaptic::haptics
