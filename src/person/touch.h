// A simulated person's sense of touch: forces, slip, and the movement of the person's own fingers.
#pragma once

#include <vector>

#include "frame/frame.h"

namespace dihaptic::person {

struct Feeling {
    Vec3 force_W = Vec3::Zero();  ///< total force that the fingers exert on the object [N]
    double grip = 0;              ///< inward force, averaged over the fingers [N]
    bool held = false;            ///< whether at least two fingers press
    bool slips = false;           ///< whether a finger slides over the body that it presses
    double slip_friction =
        0;            ///< that finger's tangential over normal force; 0 if the body turns under it
    double rise = 0;  ///< upward speed, averaged over the fingertips [m/s]
    Vec3 acceleration_W = Vec3::Zero();  ///< acceleration of the hand [m/s^2]
    double friction = 0;                 ///< friction of the skin on the touched body; 0 if none
    int body = -1;                       ///< index of the body that the fingers press; -1 if none
};

class Touch {
  public:
    /// `first`: index of the hand's first finger. `sides`: unit vectors from the hand's centre to
    /// the fingers. `frictions`: friction between a finger and each body of the scene, without
    /// perturbations. `tick`: [s].
    Touch(size_t first, std::vector<Vec3> sides, std::vector<double> frictions, double tick);

    void restart() noexcept;
    /// Returns what is felt in this Frame. Every Frame must be passed, in order.
    Feeling feel(const frame::Frame& frame) noexcept;

  private:
    size_t first_;
    std::vector<Vec3> sides_;
    std::vector<double> frictions_;
    double tick_;
    std::vector<double> slid_;  // for each finger, distance slid without stopping [m]
    Vec3 v_WH_ = Vec3::Zero();  // mean velocity of the handles in the last Frame [m/s]
    Vec3 a_WH_ = Vec3::Zero();  // mean acceleration of the handles, smoothed [m/s^2]
    bool started_ = false;
};

}  // namespace dihaptic::person
