#include "person/felt_hand.h"

#include <algorithm>

namespace dihaptic::person {
namespace {

constexpr double kFeelTime = 0.05;  // same as kFeelTime in hand/finger.h [s]
constexpr double kStill = 0.05;     // speed below which the hand is felt to be still [m/s]

}  // namespace

void FeltHand::restart() noexcept {
    velocities_.clear();
    velocity_.setZero();
    force_ = moved_at_ = 0;
}

void FeltHand::feel(const frame::Frame& frame, double now, double tick) noexcept {
    centre_ = velocity_ = Vec3::Zero();
    double force = 0;
    for (size_t i = 0; i < places_.size(); ++i) {
        const frame::FingerFrame& finger = frame.fingers[first_ + i];
        centre_ += (finger.p_WH - places_[i].offset) / fingers();
        velocity_ += finger.v_WH / fingers();
        force += finger.f_sent_W.norm() / fingers();
    }
    if (velocity_.norm() > kStill) moved_at_ = now;
    force_ += (force - force_) * std::clamp(tick / kFeelTime, 0.0, 1.0);
    half_ = 0;
    for (size_t i = 0; i < places_.size(); ++i) {
        const Vec3& p_WH = frame.fingers[first_ + i].p_WH;
        half_ += (p_WH - places_[i].offset - centre_).dot(places_[i].side) / fingers();
    }
    velocities_.add(velocity_);
}

}  // namespace dihaptic::person
