// What mouse and keys mean for the simulated hand.
//
//     move                    left and right across the picture, up and down
//     move with Shift         left and right, toward you and away
//     wheel, Space, V         squeeze and let go
//     drag                    turn: sideways about the vertical, up and down about the line of
//     sight
#pragma once

#include <QPointF>

#include "hand/mouse.h"
#include "scene/camera.h"

namespace dihaptic::gui {

class MouseHand {
  public:
    static constexpr double kNotch = 0.003;    ///< of aperture, a notch of the wheel [m]
    static constexpr double kKeySpeed = 0.08;  ///< of aperture, while a key is held [m/s]
    static constexpr double kMostGrip = 4;     ///< at which it closes no further [N]
    static constexpr double kTurn = 0.008;     ///< by a drag [rad/pixel]

    enum class Squeeze { none, close, open };

    explicit MouseHand(const hand::Posture& start) : goal_(start) {}

    /// The pointer went `pixels` (x right, y down) in a picture of that height, seen by `camera`;
    /// in depth: toward the person and away, in place of up and down.
    void move(const QPointF& pixels, const scene::Camera& camera, int height, bool in_depth);
    void turn(const QPointF& pixels);
    /// How hard it squeezes now [N]; not a number with one finger.
    void set_grip(double grip) { grip_ = grip; }
    /// Toward closing, if positive.
    void wheel(double notches);
    /// While keys are held: `h` seconds went by.
    void squeeze(Squeeze keys, double h);

    const hand::Posture& goal() const { return goal_; }

  private:
    void close(double way);

    hand::Posture goal_;
    double grip_ = 0;
};

}  // namespace dihaptic::gui
