// WorkspaceTurn turns the workspaces of all devices together, so that a hand movement to the right
// remains a movement to the right on the screen when the camera moves around the scene. If the
// workspaces are turned by the angle a about the vertical axis z through C,
//
//     p_WH = c + T (p_0H - c)               T: rotation by a about z
//     v_WH = T v_0H + a' z x (p_WH - c) and likewise for orientation and angular velocity
//     f_0H = T^-1 f_WH
//
// where the index 0 denotes the world without the turn. All checks made in axes fixed to the
// devices (speeds, walls, limits) are independent of the turn. The power f_WH . (v_WH - a' z x
// (p_WH - c)) equals f_0H . v_0H; the rest of f_WH . v_WH is the power of the turn itself.
//
// C is the mean of the devices' origins. With this choice, the reachable space stays in place, no
// point in it moves faster than necessary, and C does not depend on the camera, which a replay does
// not have. The rate a' changes by at most kMostAcceleration per second, so that neither force nor
// velocity jumps.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "haptics/coupling.h"

namespace dihaptic::servo {

class WorkspaceTurn {
  public:
    /// At this rate, a handle at rest 0.2 m from the axis moves at 0.2 m/s: the speed of a calm
    /// hand, and 2 % of the speed at which force is switched off. A force of 8.5 N changes by 8.5
    /// N/s in the device's axes, which is 0.3 % of the limit.
    static constexpr double kMostRate = 1;          // [rad/s]
    static constexpr double kMostAcceleration = 4;  // [rad/s^2]

    WorkspaceTurn() = default;
    /// `X_WD` contains the pose of each device, without the turn.
    explicit WorkspaceTurn(const std::vector<Pose>& X_WD) {
        for (const Pose& pose : X_WD) p_WC_ += pose.p / static_cast<double>(X_WD.size());
    }

    double angle() const noexcept { return angle_; }  ///< a [rad]
    double rate() const noexcept { return rate_; }    ///< a', from this tick to the next [rad/s]
    void set_angle(double angle) noexcept {
        angle_ = angle;
        R_ = Quat(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
    }
    /// Advances to the next tick, which is `elapsed` [s] after the last one.
    void advance(double elapsed) noexcept {
        if (rate_ != 0) set_angle(angle_ + rate_ * elapsed);
    }
    /// Sets the rate from this tick on, within the limits above. `elapsed` is the time since the
    /// last order or the length of a tick, whichever is longer [s]; otherwise, if ticks are late,
    /// the turn could not slow down in time.
    void order(double rate, double elapsed) noexcept {
        const double change = kMostAcceleration * elapsed;
        rate_ = std::clamp(std::clamp(rate, -kMostRate, kMostRate), rate_ - change, rate_ + change);
    }
    void stop() noexcept { rate_ = 0; }
    /// The rate to order at `angle` in order to reach `goal` [rad] by the shorter way: kMostRate
    /// or, near the goal, a rate proportional to the remaining angle, so that the turn slows down
    /// by at most kMostAcceleration.
    static double rate_toward(double goal, double angle) noexcept {
        constexpr double kThere = 1e-6;  // [rad]
        const double way = std::remainder(goal - angle, 2 * std::numbers::pi);
        if (std::abs(way) < kThere) return 0;
        return std::clamp(kMostAcceleration / kMostRate * way, -kMostRate, kMostRate);
    }

    const Quat& R() const noexcept { return R_; }                     ///< T
    Vec3 angular_velocity() const noexcept { return {0, 0, rate_}; }  ///< [rad/s]
    Vec3 turned(const Vec3& p) const noexcept { return angle_ == 0 ? p : p_WC_ + R_ * (p - p_WC_); }
    Vec3 unturned(const Vec3& p) const noexcept {
        return angle_ == 0 ? p : p_WC_ + R_.conjugate() * (p - p_WC_);
    }
    Pose turned(const Pose& X) const noexcept { return {R_ * X.R, turned(X.p)}; }
    /// `orientation` states whether the handle has an orientation and an angular velocity.
    frame::Handle turned(const frame::Handle& handle, bool orientation) const noexcept {
        if (angle_ == 0 && rate_ == 0) return handle;
        frame::Handle out;
        out.p_WH = turned(handle.p_WH);
        out.v_WH = R_ * handle.v_WH + angular_velocity().cross(out.p_WH - p_WC_);
        if (!orientation) return out;
        out.R_WH = R_ * handle.R_WH;
        out.w_WH = R_ * handle.w_WH + angular_velocity();
        return out;
    }
    Wrench turned(const Wrench& w) const noexcept {
        return angle_ == 0 ? w : Wrench{R_ * w.force, R_ * w.torque};
    }
    Wrench unturned(const Wrench& w) const noexcept {
        return angle_ == 0 ? w : Wrench{R_.conjugate() * w.force, R_.conjugate() * w.torque};
    }

  private:
    Vec3 p_WC_ = Vec3::Zero();
    double angle_ = 0;
    double rate_ = 0;
    Quat R_ = Quat::Identity();
};

}  // namespace dihaptic::servo
