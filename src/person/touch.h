// A simulated person's touch: forces, slip, and the movement of the person's own fingers.
#pragma once

#include <vector>

#include "frame/frame.h"

namespace dihaptic::person {

struct Feeling {
    Vec3 force_W = Vec3::Zero();  ///< of all fingers together on what they hold [N]
    double grip = 0;              ///< force with which fingers press inward, their mean [N]
    bool held = false;            ///< two fingers or more press
    bool slips = false;           ///< a finger slides over what it presses
    double slip_friction = 0;  ///< tangential over normal force there; 0: it turns under the finger
    double rise = 0;           ///< upward speed of the fingertips, their mean [m/s]
    Vec3 acceleration_W = Vec3::Zero();  ///< of the hand [m/s^2]
    double friction = 0;                 ///< of the skin on what it touches; 0: touches nothing
    int body = -1;                       ///< index of the body that fingers press; -1: none
};

class Touch {
  public:
    /// `sides`: unit directions of the fingers from the hand's centre. `frictions`: of a finger on
    /// each body of the scene, unperturbed. `tick` [s].
    Touch(std::vector<Vec3> sides, std::vector<double> frictions, double tick);

    void restart() noexcept;
    /// What is felt in this Frame. Every Frame has to be passed, in order.
    Feeling feel(const frame::Frame& frame) noexcept;

  private:
    std::vector<Vec3> sides_;
    std::vector<double> frictions_;
    double tick_;
    std::vector<double> slid_;  // by finger: distance slid without a stop [m]
    Vec3 v_WH_ = Vec3::Zero();  // mean of the handles in the last Frame [m/s]
    Vec3 a_WH_ = Vec3::Zero();  // their mean acceleration, smoothed [m/s^2]
    bool started_ = false;
};

}  // namespace dihaptic::person
