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
    static constexpr double kMostGrip = 4;     ///< grip force above which it closes no further [N]
    static constexpr double kTurn = 0.008;     ///< turn by a drag [rad/pixel]

    enum class Squeeze { none, close, open };

    explicit MouseHand(const hand::Posture& start) : goal_(start) {}

    /// The pointer went `pixels` (x right, y down) in a picture of `height` pixels, seen by
    /// `camera`. `in_depth`: toward the person and away, in place of up and down.
    void move(const QPointF& pixels, const scene::Camera& camera, int height, bool in_depth);
    void turn(const QPointF& pixels);
    /// Grip force now [N]; NaN with one finger.
    void set_grip(double grip) { grip_ = grip; }
    /// `notches`: positive closes the hand.
    void wheel(double notches);
    /// `keys` were held for `h` seconds.
    void squeeze(Squeeze keys, double h);

    const hand::Posture& goal() const { return goal_; }

  private:
    void close(double way);

    hand::Posture goal_;
    double grip_ = 0;
};

}  // namespace dihaptic::gui
