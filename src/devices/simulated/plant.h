// Mechanics of a simulated device held by a simulated finger, modelled as a single point mass:
//
//     m a = f_finger + f_device + f_friction
//
// integrated at 10 kHz (semi-implicit Euler). The device's force is held from one write to the
// next, is clamped to its peak, and acts `delay_ticks` ticks late. Coulomb friction removes up to
// friction * h of momentum per step and holds the endpoint if it can. If orientation is measured,
// the endpoint also rotates without friction, with a moment of inertia I that is equal about all
// axes:
//
//     I dw/dt = t_finger + t_device,    R <- exp(h w) R
//
// With `arm: phantom`, the links and joints of a Premium replace the point mass (arm.h).
#pragma once

#include <vector>

#include "base/clock.h"
#include "devices/past.h"
#include "devices/simulated/arm.h"
#include "hand/finger.h"

namespace dihaptic::devices::simulated {

class Plant {
  public:
    Plant(const Options& options, const hand::Impedance& impedance, const hand::TremorSpec& tremor,
          uint64_t seed, int finger, const hand::Driver& driver, const Pose& X_WD = {});

    /// Whether the integration below converges. With a = k h^2 / m and b = c h / m, the roots of
    /// its characteristic polynomial z^2 - (2 - a - b) z + 1 - b lie inside the unit circle if a +
    /// 2 b < 4. k is the stiffness at the device's peak force. Rotation is checked in the same way.
    static bool holds(const Options& options, const hand::Impedance& impedance);

    /// Puts the endpoint, at rest, at the position that the finger aims at at time `now`.
    void begin(Time now) noexcept;
    /// Integrates up to time `now`.
    void advance(Time now) noexcept;
    /// Sets the wrench to be held from now on, in world axes. Returns true if it had to be clamped.
    bool hold(const Wrench& wrench_W) noexcept;
    /// Sets the force to zero at once, including forces that are still delayed.
    void release() noexcept;

    /// The arm; null unless `arm: phantom` is set.
    const Arm* arm() const { return arm_ ? &*arm_ : nullptr; }
    const Vec3& p_WH() const { return p_; }
    const Vec3& v_WH() const { return v_; }
    const Quat& R_WH() const { return R_; }
    const Vec3& w_WH() const { return w_; }

  private:
    static constexpr Time kStep = std::chrono::microseconds(100);

    void move_point(const hand::FingerTarget& target, const Vec3& f_device, double h) noexcept;
    void move_arm(const hand::FingerTarget& target, const Vec3& f_device, double h) noexcept;

    Options options_;
    Pose X_WD_;  // true pose of D
    std::optional<Arm> arm_;
    hand::Finger finger_;
    hand::Tremor tremor_;
    int index_;
    const hand::Driver& driver_;
    Time time_{0};
    Vec3 p_ = Vec3::Zero();
    Vec3 v_ = Vec3::Zero();
    Quat R_ = Quat::Identity();
    Vec3 w_ = Vec3::Zero();
    std::vector<Wrench> pending_;  // the last delay_ticks + 1 wrenches, of which the oldest acts
    size_t newest_ = 0;
};

/// A position as reported by encoders and a driver: rounded to the encoders' resolution, with a
/// velocity computed from past positions.
class Encoder {
  public:
    explicit Encoder(const Options& options)
        : step_(options.position_step), past_(options.velocity_window) {}

    struct Measured {
        Vec3 p;
        Vec3 v;
    };
    Measured measure(Time now, const Vec3& p, const Vec3& v) noexcept;

  private:
    double step_;
    Past<Vec3> past_;
};

/// Like Encoder, for an arm with an encoder in each joint.
class JointEncoder {
  public:
    explicit JointEncoder(const Options& options) : past_(options.velocity_window) {}

    Encoder::Measured measure(Time now, const Arm& arm) noexcept;

  private:
    Past<Vec3> past_;
};

/// Like Encoder, for an orientation. The gimbal has one encoder for each angle of rotation_xyz().
class Gimbal {
  public:
    explicit Gimbal(const Options& options)
        : step_(options.angle_step), past_(options.velocity_window) {}

    struct Measured {
        Quat R;
        Vec3 w;
    };
    Measured measure(Time now, const Quat& R, const Vec3& w) noexcept;

  private:
    double step_;
    Past<Quat> past_;
};

}  // namespace dihaptic::devices::simulated
