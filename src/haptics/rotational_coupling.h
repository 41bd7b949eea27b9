// RotationalCoupling is the rotational spring and damper between a proxy and a handle whose
// orientation is measured, in addition to any coupling of their positions. README.md has the
// derivation.
#pragma once

#include "haptics/coupling.h"

namespace dihaptic::haptics {

class RotationalCoupling {
  public:
    /// `inertia` is the inertia of the proxy itself about P [kg*m^2]; `R_HP` is the proxy's
    /// orientation relative to the handle, which is canonical when the device is in its neutral
    /// orientation.
    RotationalCoupling(const frame::CouplingSettings& settings, double inertia, const Quat& R_HP)
        : settings_(settings), inertia_(inertia), R_HP_(R_HP) {}

    void retune(const frame::CouplingSettings& settings) noexcept { settings_ = settings; }
    /// Orientation R_WP of a proxy that does not lag behind the handle.
    Quat wanted(const frame::Handle& handle) const noexcept { return handle.R_WH * R_HP_; }
    /// Includes the spring and the damper in the proxy's inertia and angular velocity. `share` is
    /// the fraction from Onset, and `h` the duration of the coming step of the world [s].
    void before_step(World& world, BodyIndex proxy, const frame::Handle& handle, double share,
                     double h) noexcept;
    /// Returns the current torque on the handle [N*m]: the spring's torque at the end of the step
    /// while the proxy touches a body, and zero in free space. When the handle turns between steps
    /// of the world, the torque keeps the direction of the step's torque and never changes its
    /// sign.
    Vec3 torque(const World& world, BodyIndex proxy, bool touching, const frame::Handle& handle,
                double share) noexcept;
    /// Energy of the spring [J]; in contact, only the energy of the part that acted in the last
    /// torque().
    double stored() const noexcept { return stored_; }

  private:
    frame::CouplingSettings settings_;
    double inertia_;
    Quat R_HP_;
    double damping_ = 0;         // c_r [N*m*s/rad]
    frame::Handle handle_;       // state in the last step
    Vec3 along_ = Vec3::Zero();  // direction of the torque in the last step; zero if there is none
    double stored_ = 0;
};

}  // namespace dihaptic::haptics
