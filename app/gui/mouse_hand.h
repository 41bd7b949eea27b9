// Moves the simulated hand by mouse and keys.
//
//     move                    left and right across the picture, up and down
//     move with Shift         left and right, toward the person and away
//     wheel, Space, V         squeeze and let go
//     drag                    turn: sideways about the vertical, up and down about the hand's own
//                             y axis, away from the person
#pragma once

#include <QPointF>

#include "hand/mouse.h"
#include "scene/camera.h"

namespace dihaptic::gui {

class MouseHand {
  public:
    static constexpr double kNotch = 0.003;    ///< aperture per notch of the wheel [m]
    static constexpr double kKeySpeed = 0.08;  ///< speed of the aperture while a key is held [m/s]
    static constexpr double kMostGrip = 4;     ///< usual value of `most_grip` [N]
    static constexpr double kTurn = 0.008;     ///< turn by a drag [rad/pixel]

    enum class Squeeze { none, close, open };

    /// `most_grip`: grip force above which it closes no further [N].
    explicit MouseHand(const hand::Posture& start, double most_grip = kMostGrip)
        : start_(start), goal_(start), pointer_(start.centre), most_grip_(most_grip) {}

    /// The highest grip force with which a mouse squeezes, for devices with this peak force: half
    /// of it, so that the rest suffices to lift [N].
    static double grip_of(double peak_force);

    /// Moves the hand as the pointer moved by `pixels` (x right, y down) in a picture of `height`
    /// pixels, seen by `camera`. `in_depth`: toward the person and away, in place of up and down.
    void move(const QPointF& pixels, const scene::Camera& camera, int height, bool in_depth);
    void turn(const QPointF& pixels);
    /// Returns to its start, with the present aperture.
    void go_back();
    /// Sets the present grip force [N]; NaN with one finger.
    void set_grip(double grip);
    /// `notches`: positive closes the hand.
    void wheel(double notches);
    /// `keys` were held for `h` seconds.
    void squeeze(Squeeze keys, double h);

    const hand::Posture& goal() const { return goal_; }

  private:
    void close(double way);

    hand::Posture start_;
    hand::Posture goal_;
    /// Where the hand would be if the desk had no edges. The hand itself stops at an edge, and
    /// leaves it as soon as this position comes back.
    Vec3 pointer_;
    double most_grip_;
    double grip_ = 0;
};

}  // namespace dihaptic::gui
