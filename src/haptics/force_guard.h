// ForceGuard stands between the force that a finger's coupling wants and the force that its device
// is sent, in every tick:
//
//     energy guard -> workspace wall -> share of soft start and dead-man switch -> Limiter
//
// The energy guard acts in the world; the others act in axes that are fixed to the device: where
// the workspace turns (servo/workspace_turn.h), in those of the world without the turn.
#pragma once

#include <limits>

#include "haptics/chatter.h"
#include "haptics/energy_guard.h"
#include "haptics/limiter.h"
#include "haptics/workspace_wall.h"

namespace dihaptic::haptics {

/// Capabilities of a device, for its limits; if its movement is scaled, in the world's measure.
struct DeviceLimits {
    double peak_force;                      ///< [N]
    double continuous_force;                ///< that it can hold for ever; infinite: not known [N]
    std::optional<WorkspaceBox> workspace;  ///< that the handle is kept in
    double peak_torque = 0;                 ///< 0: it renders no torque [N*m]
    double continuous_torque = std::numeric_limits<double>::infinity();  ///< [N*m]
    double scale = 1;  ///< of forces and lengths here over those of the hand
};

/// What the guard had to do; see also LimitFlags and EnergyFlags.
enum GuardFlags : unsigned {
    kPushedInward = 1u << 16,  ///< the handle was pushed back into the workspace
    kSoftStarted = 1u << 17,   ///< the force was still rising
    kSwitchedOff = 1u << 18,   ///< nobody held the dead-man switch
    kRiseBounded = 1u << 19,   ///< the force was kept from rising while ticks were late
};

class ForceGuard {
  public:
    /// `tick`: duration of a tick [s].
    ForceGuard(const SafetySettings& settings, const DeviceLimits& limits, double tick);

    /// Wrench that the handle is to feel from its coupling, which asks for `asked_W`. `X_WP`: its
    /// proxy after the tick's step; `stored`: energy in the coupling's springs [J]; `stepped`:
    /// whether the world stepped in this tick. The torque is zero if the device renders none.
    Wrench shape(const Wrench& asked_W, const Handle& handle, const Pose& X_WP, double stored,
                 bool stepped, unsigned& flags) noexcept;
    /// Force of the workspace wall on the handle [N].
    Vec3 push(const Handle& handle, unsigned& flags) const noexcept;
    /// The part of both together that the device may be sent. `allowed`: by the dead-man switch,
    /// without which it is zero at once; `share`: that of SoftStart.
    Wrench limit(const Wrench& felt, bool allowed, double share, unsigned& flags) noexcept;
    /// Notes that zero was sent instead of the result of limit(): force rises again from there.
    void drop() noexcept;
    /// Begins anew after a pause: force begins at zero, and energy generated before is forgotten.
    void restart() noexcept;
    /// Energy that the coupling keeps feeding into the hand: EnergyGuard::feeding() [J].
    double feeding() const { return energy_.feeding(); }
    /// Amplitude of a force that alternates from tick to tick: Chatter::amplitude() [N].
    double chatter() const { return chatter_.amplitude(); }
    /// Energy that the coupling generated, by EnergyGuard::generated() [J].
    double generated() const { return energy_.generated(); }

  private:
    double tick_;
    EnergyGuard energy_;
    WorkspaceWall wall_;
    Limiter limiter_;
    std::optional<Limiter> torque_limiter_;  // of a device that renders torque
    Chatter chatter_;
};

}  // namespace dihaptic::haptics
