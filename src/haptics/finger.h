// One finger in the world: its proxy, the coupling that ties the proxy to the handle, and the
// limiter that every force passes on its way to the device.
#pragma once

#include "haptics/coupling.h"
#include "haptics/limiter.h"

namespace dihaptic::haptics {

class Finger {
  public:
    /// `finger`'s proxy is body `proxy` of the world. `max_force`: the magnitude limit [N].
    Finger(const scene::Finger& finger, BodyIndex proxy, const CouplingSettings& coupling,
           double max_force, double max_force_rate);

    BodyIndex proxy() const { return proxy_; }
    const ProxyTouch& touch() const { return touch_; }

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
    Output force(const World& world, const Handle& handle, double tick) noexcept;

  private:
    BodyIndex proxy_;
    Coupling coupling_;
    Limiter limiter_;
    ProxyTouch touch_;
};

}  // namespace dihaptic::haptics
