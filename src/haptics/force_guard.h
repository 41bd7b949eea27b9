// ForceGuard acts, in every tick, between the force requested by a finger's coupling and the force
// sent to its device:
//
//     energy guard -> workspace wall -> fraction of soft start and dead-man switch -> Limiter
//
// The energy guard acts in the world; the others act in axes fixed to the device: if the workspace
// turns (servo/workspace_turn.h), these are the world's axes before the turn.
#pragma once

#include "frame/device_info.h"
#include "haptics/chatter.h"
#include "haptics/energy_guard.h"
#include "haptics/limiter.h"
#include "haptics/workspace_wall.h"

namespace dihaptic::haptics {

/// Each intervention is added to `status`.
class ForceGuard {
  public:
    /// `box`: in which the handle is kept; `tick`: duration of a tick [s].
    ForceGuard(const frame::SafetySettings& settings, const frame::DeviceInfo& device,
               const std::optional<WorkspaceBox>& box, double tick);

    /// Wrench on the handle from its coupling, which requests `asked_W`. `X_WP`: its
    /// proxy after the tick's step; `stored`: energy in the coupling's springs [J]; `stepped`:
    /// whether the world stepped in this tick. The torque is zero if the device renders none.
    Wrench shape(const Wrench& asked_W, const frame::Handle& handle, const Pose& X_WP,
                 double stored, bool stepped, uint32_t& status) noexcept;
    /// Force of the workspace wall on the handle [N].
    Vec3 push(const frame::Handle& handle, uint32_t& status) const noexcept;
    /// The part of `felt`, the sum of shape() and push(), that may be sent to the device.
    /// `allowed`: whether the dead-man switch is held; if not, the result is zero at once. `share`:
    /// the fraction from SoftStart.
    Wrench limit(const Wrench& felt, bool allowed, double share, uint32_t& status) noexcept;
    /// Notes that zero was sent instead of the result of limit(): force rises again from there.
    void drop() noexcept;
    /// Starts again after a pause: force starts at zero, and energy generated before is forgotten.
    void restart() noexcept;
    /// Energy that the coupling keeps feeding into the hand: EnergyGuard::feeding() [J].
    double feeding() const { return energy_.feeding(); }
    /// Amplitude of a force alternating from tick to tick: Chatter::amplitude() [N].
    double chatter() const { return chatter_.amplitude(); }
    /// Energy that the coupling generated, by EnergyGuard::generated() [J].
    double generated() const { return energy_.generated(); }

  private:
    double tick_;
    EnergyGuard energy_;
    WorkspaceWall wall_;
    Limiter limiter_;
    std::optional<Limiter> torque_limiter_;  // for a device that renders torque
    Chatter chatter_;
};

}  // namespace dihaptic::haptics
