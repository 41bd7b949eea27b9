// Moves the simulated hand by mouse and keys.
//
//     move                    moves it left and right across the picture, up and down
//     move with Shift         moves it left and right, toward the person and away
//     wheel, Space, V         squeeze and let go
//     drag                    turns it: sideways about the vertical, up and down about the hand's
//                             own y axis, which points away from the person
#pragma once

#include <QPointF>

#include "hand/mouse.h"
#include "scene/camera.h"

namespace dihaptic::gui {

class MouseHand {
  public:
    static constexpr double kNotch = 0.003;    ///< change of aperture per notch of the wheel [m]
    static constexpr double kKeySpeed = 0.08;  ///< speed of the aperture while a key is held [m/s]
    static constexpr double kMostGrip = 4;     ///< usual value of `most_grip` [N]
    static constexpr double kTurn = 0.008;     ///< rotation by a drag [rad/pixel]

    enum class Squeeze { none, close, open };

    /// `most_grip`: grip force above which the hand does not close any further [N].
    explicit MouseHand(const hand::Posture& start, double most_grip = kMostGrip)
        : start_(start), goal_(start), pointer_(start.centre), most_grip_(most_grip) {}

    /// The largest grip force that the mouse may command with devices of this peak force [N]: half
    /// of it, which leaves enough force for lifting.
    static double grip_of(double peak_force);

    /// Moves the hand after the pointer moved by `pixels` (x right, y down) in a picture of
    /// `height` pixels, seen by `camera`. `in_depth`: whether vertical movements of the pointer
    /// move the hand away from and toward the person, instead of up and down.
    void move(const QPointF& pixels, const scene::Camera& camera, int height, bool in_depth);
    void turn(const QPointF& pixels);
    /// Moves the hand back to its start, with its current aperture.
    void go_back();
    /// Sets the current grip force [N]; NaN if there is only one finger.
    void set_grip(double grip);
    /// Opens or closes the hand by `notches` of the wheel; positive values close it.
    void wheel(double notches);
    /// Opens or closes the hand as if `keys` had been held for `h` seconds.
    void squeeze(Squeeze keys, double h);

    const hand::Posture& goal() const { return goal_; }

  private:
    void close(double way);

    hand::Posture start_;
    hand::Posture goal_;
    /// Position that the hand would have if the desk had no edges. The hand itself stops at an
    /// edge, and moves again as soon as this position is back within the edges.
    Vec3 pointer_;
    double most_grip_;
    double grip_ = 0;
};

}  // namespace dihaptic::gui
