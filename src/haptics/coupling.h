// Couplings connect a handle to its proxy. README.md derives the equations.
#pragma once

#include "dynamics/world.h"
#include "frame/handle.h"
#include "frame/haptics_settings.h"
#include "haptics/onset.h"

namespace dihaptic::haptics {

using dynamics::BodyIndex;
using dynamics::World;

/// All contacts of a proxy in the last step, combined into one.
struct ProxyTouch {
    bool touching = false;      ///< whether a body pressed against the proxy
    Vec3 n_W = Vec3::Zero();    ///< direction of the total normal force on the proxy; unit, or zero
                                ///< if there is none
    double normal_force = 0;    ///< magnitude of the total normal force [N]
    double friction = 0;        ///< mean coefficient of friction, weighted by normal force
    Vec3 f_P_W = Vec3::Zero();  ///< total contact force on the proxy [N]
};

/// The force on the handle, and the energy stored in the springs that exert it.
struct Pull {
    Vec3 f_H_W = Vec3::Zero();  ///< [N]
    double stored = 0;          ///< [J]
};

/// The force that a rigid proxy exerts on the handle while it touches a body: a spring and a
/// damper. The couplings below differ in how they move the proxy.
class BodyCoupling {
  public:
    /// Returns the current force. It is zero in free space, where the spring only moves the mass of
    /// the proxy itself. When the handle moves between steps of the world, the force stays within
    /// the friction cone of the step's contact, and only the part of the stretch that acts counts
    /// as stored energy.
    Pull pull(const World& world, BodyIndex proxy, const ProxyTouch& touch,
              const frame::Handle& handle) const noexcept;
    Onset& onset() noexcept { return onset_; }
    void retune(const frame::CouplingSettings& settings) noexcept { settings_ = settings; }

  protected:
    BodyCoupling(const frame::CouplingSettings& settings, double mass)
        : settings_(settings), mass_(mass), onset_(settings.onset) {}
    /// Prepares for the coming step of the world, which lasts h [s].
    void begin_step(const frame::Handle& handle, double h) noexcept;

    frame::CouplingSettings settings_;
    double mass_;  // mass of the proxy itself [kg]
    Onset onset_;
    double damping_ = 0;  // c [N*s/m]

  private:
    frame::Handle handle_;  // state at the last step
};

/// The spring acts with its state at the end of the step (backward Euler). Everything else is left
/// to the contact solver.
class ImplicitCoupling : public BodyCoupling {
  public:
    /// `mass` is the mass of the proxy itself [kg].
    ImplicitCoupling(const frame::CouplingSettings& settings, double mass)
        : BodyCoupling(settings, mass) {}

    /// Includes the spring and the damper in the proxy's mass and velocity. `h` is the duration of
    /// the coming step of the world [s].
    void before_step(World& world, BodyIndex proxy, const frame::Handle& handle, double h) noexcept;
};

/// Before each step, a bounded impulse gives the proxy the velocity with which it would reach the
/// handle within the step. In free space, the bound is the largest force that the hand may feel; in
/// contact, it is the force of the spring and damper. Proposed in the report of 2012.
class VelocityImpulse : public BodyCoupling {
  public:
    /// `mass` is the mass of the proxy itself [kg], and `max_force` the largest force that the hand
    /// may feel [N].
    VelocityImpulse(const frame::CouplingSettings& settings, double mass, double max_force)
        : BodyCoupling(settings, mass), max_force_(max_force) {}

    void before_step(World& world, BodyIndex proxy, const frame::Handle& handle, double h,
                     bool was_touching) noexcept;

  private:
    double max_force_;
};

/// The 2012 system: springs and dampers act as explicit forces on both sides, with smoothing on the
/// hand's side. Both forces are computed from the positions of proxy and handle at the tick, before
/// the world steps.
class DualSpring {
  public:
    explicit DualSpring(const frame::CouplingSettings& settings)
        : settings_(settings), onset_(settings.onset) {}

    void before_step(World& world, BodyIndex proxy, const frame::Handle& handle, double h,
                     bool was_touching) noexcept;
    /// Updates the force. Must be called in every tick, before the step of the world if there is
    /// one.
    void sample(const World& world, BodyIndex proxy, const frame::Handle& handle,
                double h) noexcept;
    Pull pull(const World& world, BodyIndex proxy, const frame::Handle& handle) const noexcept {
        const Vec3 stretch = world.state(proxy).X_WB.p - handle.p_WH;
        return {f_H_W_, onset_.share() * settings_.stiffness / 2 * stretch.squaredNorm()};
    }
    /// Starts with the proxy at the handle, so that the spring is not stretched.
    void place() noexcept { f_H_W_.setZero(); }
    Onset& onset() noexcept { return onset_; }
    void retune(const frame::CouplingSettings& settings) noexcept { settings_ = settings; }

  private:
    frame::CouplingSettings settings_;
    Onset onset_;
    Vec3 f_H_W_ = Vec3::Zero();  // smoothed force on the handle [N]
};

/// Damping c: the setting if given, otherwise the default for a world step of h [N*s/m].
double damping(const frame::CouplingSettings& settings, double h);
/// Damping c_r of the rotational spring: the setting if given, otherwise the default [N*m*s/rad].
double turn_damping(const frame::CouplingSettings& settings, double h);

}  // namespace dihaptic::haptics
