// MouseDriver lets the mouse move a hand, for set-ups without devices. The goal jumps whenever an
// input event arrives; the hand follows the goal with critical damping and the time constant
// kFollow:
//
//     x(t) = g + (e + (v + w e) s) exp(-w s),    e = x(t0) - g,  s = t - t0,  w = 1 / kFollow
//
// for each coordinate x of the posture, where t0 is the first tick that knows the goal g. It begins
// there, and not when the event arrived, because the hand must not jump from where it was sent in
// the ticks between.
#pragma once

#include "base/latest.h"
#include "hand/driver.h"
#include "hand/spec.h"

namespace dihaptic::hand {

/// Position, orientation and aperture of a hand.
struct Posture {
    Vec3 centre = Vec3::Zero();  ///< centre of the hand, in world axes [m]
    double aperture = 0;         ///< twice each finger's distance from the centre [m]
    double yaw = 0;              ///< rotation about the vertical, applied first [rad]
    double roll = 0;             ///< rotation about the hand's own y axis, which points away from
                                 ///< the person [rad]
};

class MouseDriver final : public Driver {
  public:
    static constexpr double kFollow = 0.04;  // [s]
    /// Smallest aperture [m]. It is negative because hands are soft: to squeeze hard, the fingers
    /// aim at points beyond each other.
    static constexpr double kTightest = -0.06;

    /// Starts like a script of `spec`. Fingers that have their own centre or aperture keep the
    /// difference from those of the hand. Throws Error like finger_places().
    MouseDriver(const HandSpec& spec, const std::vector<std::string>& fingers);

    /// Moves the hand to `goal` from the next tick on. Must be called from a single thread other
    /// than the servo's.
    void follow(const Posture& goal) noexcept;
    const Posture& goal() const { return goal_; }

    /// The session continues until it is stopped, but a duration is required: that of the longest
    /// script.
    double duration() const override { return kLongestScript; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    using Coordinates = Eigen::Matrix<double, 6, 1>;
    struct Motion {
        Coordinates x = Coordinates::Zero();
        Coordinates v = Coordinates::Zero();
    };
    struct Transit {
        double start = 0;  // [s]
        Motion from;
        Coordinates goal = Coordinates::Zero();

        Motion at(double t) const noexcept;
    };
    static Coordinates coordinates(const Posture& posture);
    FingerTarget do_target(int finger, double t) const noexcept override;

    std::vector<FingerPlace> fingers_;
    std::vector<Phase> phases_;
    Posture start_;
    Posture goal_;
    /// From the window's thread to the servo's.
    mutable Latest<Coordinates> wanted_{Coordinates::Zero()};
    mutable Transit transit_;  ///< the servo's
};

}  // namespace dihaptic::hand
