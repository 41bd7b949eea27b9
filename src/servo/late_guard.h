// LateGuard keeps a loop whose ticks come late from shaking the hand: it reports lateness as a
// fault, softens the couplings, and limits how fast forces may rise. The equations are in
// haptics/late_loop.h. If all devices are simulated, lateness is reported but changes nothing,
// because nobody is harmed.
#pragma once

#include "base/unmeasured.h"
#include "frame/settings.h"
#include "haptics/safety.h"
#include "servo/lateness.h"

namespace dihaptic::servo {

class LateGuard {
  public:
    /// What the loop that runs the ticks has noted about the last one.
    struct Timing {
        double lateness = kUnmeasured;   ///< [s]
        double last_tick = kUnmeasured;  ///< duration of the last tick [s]
        bool overrun = false;
    };
    /// The motion of a handle since the last tick, before the workspaces are turned.
    struct Move {
        Vec3 way = Vec3::Zero();   ///< [m]
        Vec3 turn = Vec3::Zero();  ///< [rad]
    };

    explicit LateGuard(const frame::Settings& settings);
    /// Takes a device into account: whether it is real, and how much it damps the hand.
    void add(const frame::DeviceInfo& device);

    void note(const Timing& timing) noexcept { timing_ = timing; }
    const Timing& timing() const { return timing_; }

    /// Judges a tick at time `now`, `elapsed` [s] after the last one. `is_first` is set if there is
    /// no last tick.
    void judge(Time now, double elapsed, bool is_first) noexcept;
    /// The lateness fault of this tick, which counts only if is_real().
    const haptics::Fault& fault() const { return fault_; }
    double elapsed() const { return elapsed_; }
    /// Forgets the lateness of all earlier ticks.
    void restart() noexcept { late_.restart(); }

    /// Whether a person's hand holds any of the devices.
    bool is_real() const { return is_real_; }
    /// Whether ticks have come late of late, but only for simulated hands.
    bool is_harmless() const { return !is_real_ && late_.sustained() > 0; }
    /// Damping of handle and hand, which determines the stiffness allowed for a late loop [N*s/m].
    /// It is the smallest value stated by any device, unless safety.hand_damping sets it.
    double damping() const { return damping_; }

    /// Returns the couplings, made no stiffer than the loop allows.
    frame::CouplingSettings softened(const frame::CouplingSettings& wanted) const noexcept;
    /// Limits how much a wrench may rise in a tick that may be late. Lateness that has just begun
    /// has not yet softened the couplings, and lateness never softens the wall or the force fields.
    /// Starting from its value in the last tick, the wrench may rise only as much as that of a
    /// spring whose stiffness is the one allowed for the loop or the coupling's own, whichever is
    /// lower, plus a slow creep that lets the force recover. `share` is that of the soft start.
    Wrench bounded(const Wrench& asked, const Wrench& last, const Move& move, double share,
                   const frame::CouplingSettings& coupling) const noexcept;

  private:
    frame::SafetySettings safety_;
    double tick_;  // [s]
    Lateness late_;
    double elapsed_ = 0;    // time since the last tick [s]
    haptics::Fault fault_;  // of this tick
    bool is_real_ = false;
    double damping_;
    Timing timing_;
};

}  // namespace dihaptic::servo
