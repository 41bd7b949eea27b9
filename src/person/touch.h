// A simulated person's touch: forces, slip, and the movement of the person's own fingers.
#pragma once

#include <vector>

#include "frame/frame.h"

namespace dihaptic::person {

struct Feeling {
    Vec3 force_W = Vec3::Zero();  ///< total force of the fingers on the object [N]
    double grip = 0;              ///< mean inward force of the fingers [N]
    bool held = false;            ///< two fingers or more press
    bool slips = false;           ///< a finger slides over the body that it presses
    double slip_friction =
        0;            ///< tangential over normal force of that finger; 0: the body turns under it
    double rise = 0;  ///< mean upward speed of the fingertips [m/s]
    Vec3 acceleration_W = Vec3::Zero();  ///< acceleration of the hand [m/s^2]
    double friction = 0;                 ///< friction of the skin on the touched body; 0: no touch
    int body = -1;                       ///< index of the body that the fingers press; -1: none
};

class Touch {
  public:
    /// `first`: index of the hand's first finger. `sides`: unit directions of the fingers from the
    /// hand's centre. `frictions`: unperturbed friction of a finger on each body of the scene.
    /// `tick` [s].
    Touch(size_t first, std::vector<Vec3> sides, std::vector<double> frictions, double tick);

    void restart() noexcept;
    /// The sensation in this Frame. Every Frame must be passed, in order.
    Feeling feel(const frame::Frame& frame) noexcept;

  private:
    size_t first_;
    std::vector<Vec3> sides_;
    std::vector<double> frictions_;
    double tick_;
    std::vector<double> slid_;  // by finger: distance slid without a stop [m]
    Vec3 v_WH_ = Vec3::Zero();  // mean of the handles in the last Frame [m/s]
    Vec3 a_WH_ = Vec3::Zero();  // their mean acceleration, smoothed [m/s^2]
    bool started_ = false;
};

}  // namespace dihaptic::person
