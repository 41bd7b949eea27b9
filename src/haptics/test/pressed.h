// A finger that presses on a fixed block, for tests of the force with each type of proxy.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>

#include "haptics/finger.h"

namespace dihaptic::haptics {

constexpr double kPressedTick = 1e-3;
constexpr double kPressedCoupling = 1000;  // [N/m]

enum class PressedProxy { rigid, point_apart, point_solved };

/// A finger above a fixed block with its top at z = 0.
class Pressed {
  public:
    Pressed(PressedProxy proxy, const scene::Surface& surface, double friction, int every = 1)
        : every_(every) {
        scene::Body block;
        block.name = "block";
        block.shape = scene::Shape::box({0.4, 0.4, 0.4});
        block.position = {0, 0, -0.2};
        block.fixed = true;
        block.friction = friction;
        block.surface = surface;
        scene::Finger spec;
        spec.name = "index";
        spec.shape = scene::Shape::sphere(kRadius);
        spec.friction = friction;
        scene_.bodies = {block};
        scene_.fingers = {spec};
        world_ = std::make_unique<World>(scene_, frame::DynamicsSettings{});
        frame::CouplingSettings coupling;
        coupling.stiffness = kPressedCoupling;
        lift_ = proxy == PressedProxy::rigid ? kRadius : 0;
        const Vec3 at(0, 0, lift_ + 0.002);
        if (proxy == PressedProxy::rigid) {
            body_ = world_->add_proxy(spec, at);
            finger_ = std::make_unique<Finger>(spec, body_, coupling, 50);
        } else {
            body_ = world_->add_point(spec, at);
            finger_ =
                proxy == PressedProxy::point_apart
                    ? std::make_unique<Finger>(
                          PointProxy(scene_, body_, coupling, frame::ProxySettings{}), body_)
                    : std::make_unique<Finger>(
                          SolvedPoint(scene_, body_, coupling, frame::ProxySettings{}), body_);
        }
        world_->activate();
        handle_ = {at, Vec3::Zero()};
        finger_->place(*world_, handle_);
    }

    /// Moves the handle to p at 50 mm/s, waits, and returns the force on it.
    Vec3 go(const Vec3& p, int wait = 500) {
        const Vec3 to = p + Vec3(0, 0, lift_);
        const Vec3 from = handle_.p_WH;
        const int ticks = std::max(1, static_cast<int>((to - from).norm() / (0.05 * kPressedTick)));
        Vec3 f = Vec3::Zero();
        for (int i = 1; i <= ticks + wait; ++i)
            f = tick(from + std::min(1.0, double(i) / ticks) * (to - from));
        return f;
    }
    /// Moves the handle to p, relative to the top of the block, within a tick. Returns the force on
    /// it.
    Vec3 move(const Vec3& p) { return tick(p + Vec3(0, 0, lift_)); }
    void set_properties(const dynamics::BodyProperties& properties) {
        world_->set_properties({0}, properties);
    }
    const Vec3& proxy() const { return world_->state(body_).X_WB.p; }
    const Finger& finger() const { return *finger_; }

  private:
    static constexpr double kRadius = 0.008;

    Vec3 tick(const Vec3& p) {
        handle_.v_WH = (p - handle_.p_WH) / kPressedTick;
        handle_.p_WH = p;
        const double step = kPressedTick * every_;
        finger_->begin_tick(*world_, handle_, step);
        if (ticks_++ % every_ == 0) {
            finger_->before_step(*world_, handle_, step);
            world_->step(step);
            finger_->after_step(*world_, handle_);
        }
        return finger_->force(*world_, handle_, kPressedTick);
    }

    scene::Scene scene_;
    std::unique_ptr<World> world_;
    std::unique_ptr<Finger> finger_;
    BodyIndex body_;
    frame::Handle handle_;
    double lift_ = 0;  // height of the handle above the point that touches the block [m]
    int every_;
    int ticks_ = 0;
};

inline std::string name_of_proxy(const ::testing::TestParamInfo<PressedProxy>& which) {
    constexpr std::array kNames{"rigid", "point_apart", "point_solved"};
    return kNames[static_cast<size_t>(which.param)];
}

}  // namespace dihaptic::haptics
