// Between what a finger's coupling wants and what its device is told, in every tick:
//
//     energy guard -> workspace wall -> share of soft start and dead-man switch -> Limiter
#pragma once

#include "haptics/energy_guard.h"
#include "haptics/limiter.h"
#include "haptics/workspace_wall.h"

namespace dihaptic::haptics {

/// What a device can do, for its limits.
struct DeviceLimits {
    double peak_force;              ///< [N]
    double continuous_force;        ///< that it can hold for ever; infinite: not known [N]
    std::optional<Vec3> workspace;  ///< edges of the box around D's origin [m]
};

/// What the guard had to do: see also LimitFlags and EnergyFlags.
enum GuardFlags : unsigned {
    kPushedInward = 1u << 16,  ///< the handle was pushed back into the workspace
    kSoftStarted = 1u << 17,   ///< the force was still rising
    kSwitchedOff = 1u << 18,   ///< nobody held the dead-man switch
};

class ForceGuard {
  public:
    /// `tick` [s].
    ForceGuard(const SafetySettings& settings, const DeviceLimits& limits, double tick,
               const Pose& X_WD);

    /// The force that the handle is to feel, for the one that the coupling wants [N]. `p_WP`: its
    /// proxy after the tick's step; `stored`: energy in the coupling's spring [J]; `stepped`: the
    /// world did in this tick.
    Vec3 shape(const Vec3& f_asked_W, const Handle& handle, const Vec3& p_WP, double stored,
               bool stepped, unsigned& flags) noexcept;
    /// The part of it that the device may be told. `allowed`: by the dead-man switch, without which
    /// force is zero at once; `share`: of SoftStart.
    Vec3 limit(const Vec3& f_H_W, bool allowed, double share, unsigned& flags) noexcept;
    /// Energy that the coupling generated, as EnergyGuard counts it [J].
    double generated() const { return energy_.generated(); }

  private:
    double tick_;
    Pose X_WD_;
    Pose X_DW_;
    EnergyGuard energy_;
    WorkspaceWall wall_;
    Limiter limiter_;
};

}  // namespace dihaptic::haptics
