// Between what a finger's coupling wants and what its device is told, in every tick:
//
//     energy guard -> workspace wall -> share of soft start and dead-man switch -> Limiter
//
// The first acts in the world, the others in axes that stand still with the device: where the
// workspace turns (servo/workspace_turn.h), those of the world without that turn.
#pragma once

#include <limits>

#include "haptics/chatter.h"
#include "haptics/energy_guard.h"
#include "haptics/limiter.h"
#include "haptics/workspace_wall.h"

namespace dihaptic::haptics {

/// What a device can do, for its limits: in the world's measure where its movement is scaled.
struct DeviceLimits {
    double peak_force;                      ///< [N]
    double continuous_force;                ///< that it can hold for ever; infinite: not known [N]
    std::optional<WorkspaceBox> workspace;  ///< that the handle is kept in
    double peak_torque = 0;                 ///< 0: it renders none [N*m]
    double continuous_torque = std::numeric_limits<double>::infinity();  ///< [N*m]
    double scale = 1;  ///< forces and lengths here over those of the hand
};

/// What the guard had to do: see also LimitFlags and EnergyFlags.
enum GuardFlags : unsigned {
    kPushedInward = 1u << 16,  ///< the handle was pushed back into the workspace
    kSoftStarted = 1u << 17,   ///< the force was still rising
    kSwitchedOff = 1u << 18,   ///< nobody held the dead-man switch
    kRiseBounded = 1u << 19,   ///< the force was kept from rising while ticks were late
};

class ForceGuard {
  public:
    /// `tick` [s].
    ForceGuard(const SafetySettings& settings, const DeviceLimits& limits, double tick);

    /// What the handle is to feel of its coupling, for what that wants. `X_WP`: its proxy after the
    /// tick's step; `stored`: energy in the coupling's springs [J]; `stepped`: the world did in
    /// this tick. No torque where the device renders none.
    Wrench shape(const Wrench& asked_W, const Handle& handle, const Pose& X_WP, double stored,
                 bool stepped, unsigned& flags) noexcept;
    /// And of the wall [N].
    Vec3 push(const Handle& handle, unsigned& flags) const noexcept;
    /// The part of both that the device may be told. `allowed`: by the dead-man switch, without
    /// which it is zero at once; `share`: of SoftStart.
    Wrench limit(const Wrench& felt, bool allowed, double share, unsigned& flags) noexcept;
    /// Zero was sent in place of what limit() gave: force rises again from there.
    void drop() noexcept;
    /// After a pause: force begins at zero, and what the coupling generated before is forgotten.
    void restart() noexcept;
    /// Energy that the coupling has gone on feeding into the hand, EnergyGuard::feeding() [J].
    double feeding() const { return energy_.feeding(); }
    /// Amplitude of a force that alternates from tick to tick, Chatter::amplitude() [N].
    double chatter() const { return chatter_.amplitude(); }
    /// Energy that the coupling generated, as EnergyGuard counts it [J].
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
