// Finger represents one finger in the world: its proxy, and the coupling between the proxy and the
// handle. Every force passes through a ForceGuard before it reaches the device.
#pragma once

#include <span>
#include <variant>

#include "haptics/coupling.h"
#include "haptics/point_proxy.h"
#include "haptics/rotational_coupling.h"
#include "haptics/solved_point.h"

namespace dihaptic::haptics {

class Finger {
  public:
    /// The proxy of `finger` is the body `proxy` of the world; `max_force` is the largest force
    /// that the hand may feel [N].
    Finger(const scene::Finger& finger, BodyIndex proxy, const frame::CouplingSettings& coupling,
           double max_force);
    /// Creates a finger whose proxy is a point.
    Finger(PointProxy point, BodyIndex proxy);
    Finger(SolvedPoint point, BodyIndex proxy);

    /// Lets the proxy turn with the handle. The body of the proxy must be able to turn.
    void turn_with_handle(const RotationalCoupling& coupling) { turn_ = coupling; }

    BodyIndex proxy() const { return proxy_; }
    const ProxyTouch& touch() const { return touch_; }
    /// Contacts that are not part of the world: those of a point proxy whose friction is "apart",
    /// at the last call of force().
    std::span<const contact::Contact> contacts() const noexcept;

    /// Sets the coupling from the coming tick on. The kind of coupling applies only to rigid
    /// proxies: a point has its own coupling.
    void retune(const frame::CouplingSettings& coupling) noexcept;

    /// Moves the proxy to the handle. Must be called before the first tick, and at each restart.
    void place(World& world, const frame::Handle& handle) noexcept;

    /// Turns a proxy that does not follow its handle's orientation along with the workspaces:
    /// rotates it by R_WT from its initial orientation and lets it continue to turn at w_WT
    /// [rad/s].
    void carry(World& world, const Quat& R_WT, const Vec3& w_WT) const noexcept;

    /// Must be called first in every tick. `step` is the time step of the world [s].
    void begin_tick(const World& world, const frame::Handle& handle, double step) noexcept;
    /// Must be called before and after the step, in ticks in which the world steps.
    void before_step(World& world, const frame::Handle& handle, double step) noexcept;
    void after_step(World& world, const frame::Handle& handle) noexcept;

    /// Must be called last in every tick. Returns the force that the coupling requests for the
    /// current state of the handle [N]. `tick` is the duration of the tick [s].
    Vec3 force(World& world, const frame::Handle& handle, double tick) noexcept;
    /// Torque that belongs to the last force() [N*m].
    const Vec3& torque() const noexcept { return torque_; }
    /// Energy stored in the coupling's springs at the last force() [J].
    double stored() const noexcept { return stored_; }

  private:
    void feel(std::span<const contact::Contact> contacts) noexcept;
    Pull pull(World& world, const frame::Handle& handle, double tick) noexcept;
    double onset_share() noexcept;

    BodyIndex proxy_;
    std::variant<ImplicitCoupling, DualSpring, VelocityImpulse, PointProxy, SolvedPoint> coupling_;
    frame::CouplingKind kind_ = frame::CouplingKind::implicit;
    double mass_ = 0;       // mass of the proxy if it is a body [kg]
    double max_force_ = 0;  // largest force that the hand may feel from a rigid proxy [N]
    std::optional<RotationalCoupling> turn_;
    Quat R_TP_ = Quat::Identity();  // initial orientation of the proxy
    ProxyTouch touch_;
    Vec3 torque_ = Vec3::Zero();
    double stored_ = 0;
    double step_ = 0;  // time step of the world [s]
};

}  // namespace dihaptic::haptics
