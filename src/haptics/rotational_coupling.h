// RotationalCoupling is the rotational spring and damper between a handle with measured orientation
// and its proxy, in addition to any coupling of their positions. README.md derives it.
#pragma once

#include "haptics/coupling.h"

namespace dihaptic::haptics {

class RotationalCoupling {
  public:
    /// `inertia`: the proxy's own, about P [kg*m^2]; `R_HP`: the proxy's canonical orientation,
    /// at the device's neutral orientation.
    RotationalCoupling(const frame::CouplingSettings& settings, double inertia, const Quat& R_HP)
        : settings_(settings), inertia_(inertia), R_HP_(R_HP) {}

    void retune(const frame::CouplingSettings& settings) noexcept { settings_ = settings; }
    /// R_WP of a proxy without lag.
    Quat wanted(const frame::Handle& handle) const noexcept { return handle.R_WH * R_HP_; }
    /// Includes spring and damper in the proxy's inertia and angular velocity. `share`: from
    /// Onset; `h`: duration of the coming step of the world [s].
    void before_step(World& world, BodyIndex proxy, const frame::Handle& handle, double share,
                     double h) noexcept;
    /// Present torque on the handle [N*m]: the spring's torque at the end of the step while the
    /// proxy touches a body, and zero in free space. When the handle turns between steps of the
    /// world, the torque stays along the step's torque, and never changes its sign.
    Vec3 torque(const World& world, BodyIndex proxy, bool touching, const frame::Handle& handle,
                double share) noexcept;
    /// Energy of the spring; in contact, only the part acting in the last torque() [J].
    double stored() const noexcept { return stored_; }

  private:
    frame::CouplingSettings settings_;
    double inertia_;
    Quat R_HP_;
    double damping_ = 0;         // c_r [N*m*s/rad]
    frame::Handle handle_;       // of the last step
    Vec3 along_ = Vec3::Zero();  // direction of the torque of the last step; zero: none
    double stored_ = 0;
};

}  // namespace dihaptic::haptics
