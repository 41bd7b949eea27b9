// Couplings connect a handle to its proxy. README.md has the equations.
#pragma once

#include "dynamics/world.h"
#include "frame/handle.h"
#include "frame/haptics_settings.h"
#include "haptics/onset.h"

namespace dihaptic::haptics {

using dynamics::BodyIndex;
using dynamics::World;

/// All contacts of a proxy in the last step, combined.
struct ProxyTouch {
    bool touching = false;    ///< whether a body pressed against the proxy
    Vec3 n_W = Vec3::Zero();  ///< direction of the summed normal force on the proxy; unit, or zero
    double normal_force = 0;  ///< magnitude of that sum [N]
    double friction = 0;      ///< coefficient of friction, weighted by normal force
    Vec3 f_P_W = Vec3::Zero();  ///< total contact force on the proxy [N]
};

/// Force on the handle, and the energy of the springs that exert it.
struct Pull {
    Vec3 f_H_W = Vec3::Zero();  ///< [N]
    double stored = 0;          ///< [J]
};

/// Force on the handle from a rigid proxy: a spring and a damper, while the proxy touches
/// a body. The couplings below differ in how they move the proxy.
class BodyCoupling {
  public:
    /// The present force: zero in free space, where the spring only moves the proxy's own mass.
    /// When the handle moves between steps of the world, the force stays within the friction cone
    /// of the step's contact, and only the acting part of the stretch counts as stored energy.
    Pull pull(const World& world, BodyIndex proxy, const ProxyTouch& touch,
              const frame::Handle& handle) const noexcept;
    Onset& onset() noexcept { return onset_; }
    void retune(const frame::CouplingSettings& settings) noexcept { settings_ = settings; }

  protected:
    BodyCoupling(const frame::CouplingSettings& settings, double mass)
        : settings_(settings), mass_(mass), onset_(settings.onset) {}
    /// Prepares the coming step of the world, of h [s].
    void begin_step(const frame::Handle& handle, double h) noexcept;

    frame::CouplingSettings settings_;
    double mass_;  // the proxy's own [kg]
    Onset onset_;
    double damping_ = 0;  // c [N*s/m]

  private:
    frame::Handle handle_;  // at the last step
};

/// The spring acts with its state at the end of the step (backward Euler); the contact solver
/// solves the rest.
class ImplicitCoupling : public BodyCoupling {
  public:
    /// `mass`: the proxy's own [kg].
    ImplicitCoupling(const frame::CouplingSettings& settings, double mass)
        : BodyCoupling(settings, mass) {}

    /// Includes spring and damper in the proxy's mass and velocity. `h`: duration of the coming
    /// step of the world [s].
    void before_step(World& world, BodyIndex proxy, const frame::Handle& handle, double h) noexcept;
};

/// Before each step the proxy gets the velocity that leads to the handle within the step, by a
/// bounded impulse: in free space, the bound is the largest force that the hand may feel; in
/// contact, it is the force of spring and damper. Proposed in the report of 2012.
class VelocityImpulse : public BodyCoupling {
  public:
    /// `mass`: the proxy's own [kg]; `max_force`: the largest that the hand may feel [N].
    VelocityImpulse(const frame::CouplingSettings& settings, double mass, double max_force)
        : BodyCoupling(settings, mass), max_force_(max_force) {}

    void before_step(World& world, BodyIndex proxy, const frame::Handle& handle, double h,
                     bool was_touching) noexcept;

  private:
    double max_force_;
};

/// The 2012 system: springs and dampers as explicit forces on both sides, smoothed toward the hand.
/// Both forces follow from the positions of proxy and handle at the tick, before the world steps.
class DualSpring {
  public:
    explicit DualSpring(const frame::CouplingSettings& settings)
        : settings_(settings), onset_(settings.onset) {}

    void before_step(World& world, BodyIndex proxy, const frame::Handle& handle, double h,
                     bool was_touching) noexcept;
    /// Updates the force; called in every tick, before the world steps if it does.
    void sample(const World& world, BodyIndex proxy, const frame::Handle& handle,
                double h) noexcept;
    Pull pull(const World& world, BodyIndex proxy, const frame::Handle& handle) const noexcept {
        const Vec3 stretch = world.state(proxy).X_WB.p - handle.p_WH;
        return {f_H_W_, onset_.share() * settings_.stiffness / 2 * stretch.squaredNorm()};
    }
    /// Starts with the proxy at the handle, with an unstretched spring.
    void place() noexcept { f_H_W_.setZero(); }
    Onset& onset() noexcept { return onset_; }
    void retune(const frame::CouplingSettings& settings) noexcept { settings_ = settings; }

  private:
    frame::CouplingSettings settings_;
    Onset onset_;
    Vec3 f_H_W_ = Vec3::Zero();  // force on the handle, smoothed [N]
};

/// c: the setting, or else its default for a world step of h [N*s/m].
double damping(const frame::CouplingSettings& settings, double h);
/// c_r of the rotational spring: the setting, or else its default [N*m*s/rad].
double turn_damping(const frame::CouplingSettings& settings, double h);

}  // namespace dihaptic::haptics
