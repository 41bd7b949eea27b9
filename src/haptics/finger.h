// One finger in the world: its proxy, the coupling that ties the proxy to the handle, and the
// limiter that every force passes on its way to the device.
#pragma once

#include <span>
#include <variant>

#include "haptics/coupling.h"
#include "haptics/limiter.h"
#include "haptics/point_proxy.h"

namespace dihaptic::haptics {

class Finger {
  public:
    /// `finger`'s proxy is body `proxy` of the world. `max_force`: the magnitude limit [N].
    Finger(const scene::Finger& finger, BodyIndex proxy, const CouplingSettings& coupling,
           double max_force, double max_force_rate);
    /// The same with a point for a proxy.
    Finger(PointProxy point, BodyIndex proxy, double max_force, double max_force_rate);

    BodyIndex proxy() const { return proxy_; }
    const ProxyTouch& touch() const { return touch_; }
    /// Contacts that the world does not know of: a point's, of the last force().
    std::span<const contact::Contact> contacts() const noexcept;

    /// Puts the proxy at the handle, before the first tick.
    void place(World& world, const Handle& handle) noexcept;

    /// First in every tick; `step` is the world's [s].
    void begin_tick(const World& world, const Handle& handle, double step) noexcept;
    /// In ticks in which the world steps: before it does, and after.
    void before_step(World& world, const Handle& handle, double step) noexcept;
    void after_step(const World& world) noexcept;

    struct Output {
        Vec3 f_asked_W = Vec3::Zero();  ///< what the coupling wants the handle to feel [N]
        Vec3 f_H_W = Vec3::Zero();      ///< what the device is told [N]
        unsigned flags = 0;             ///< LimitFlags
    };
    /// Last in every tick: force for the handle as it is now. `tick`: its length [s].
    Output force(World& world, const Handle& handle, double tick) noexcept;

  private:
    void feel(std::span<const contact::Contact> contacts) noexcept;

    BodyIndex proxy_;
    std::variant<ImplicitCoupling, DualSpring, VelocityImpulse, PointProxy> coupling_;
    Limiter limiter_;
    ProxyTouch touch_;
    double step_ = 0;  // of the world [s]
};

}  // namespace dihaptic::haptics
