#include "hand/mouse.h"

#include <algorithm>
#include <cmath>

#include "hand/places.h"

namespace dihaptic::hand {

MouseDriver::MouseDriver(const HandSpec& spec, const std::vector<std::string>& fingers)
    : fingers_(finger_places(spec, fingers)),
      phases_{{"mouse", 0, kLongestScript}},
      start_{spec.centre, spec.aperture},
      goal_(start_) {
    transit_.from.x = transit_.goal = coordinates(goal_);
}

MouseDriver::Coordinates MouseDriver::coordinates(const Posture& posture) {
    Coordinates x;
    x << posture.centre, posture.aperture, posture.yaw, posture.roll;
    return x;
}

void MouseDriver::follow(const Posture& goal) noexcept {
    goal_ = goal;
    goal_.aperture = std::max(kTightest, goal.aperture);
    wanted_.publish(coordinates(goal_));
}

MouseDriver::Motion MouseDriver::Transit::at(double t) const noexcept {
    const double s = std::max(0.0, t - start);
    const double w = 1 / kFollow;
    const Coordinates e = from.x - goal;
    const Coordinates pull = from.v + w * e;
    const double left = std::exp(-w * s);
    return {goal + left * (e + s * pull), left * (from.v - w * s * pull)};
}

FingerTarget MouseDriver::do_target(int finger, double t) const noexcept {
    if (wanted_.is_new()) transit_ = {t, transit_.at(t), wanted_.read()};
    const Motion hand = transit_.at(t);
    const FingerPlace& place = fingers_[static_cast<size_t>(finger)];
    const Quat yaw(Eigen::AngleAxisd(hand.x[4], Vec3::UnitZ()));
    const Quat R = yaw * Quat(Eigen::AngleAxisd(hand.x[5], Vec3::UnitY()));
    const Vec3 w = hand.v[4] * Vec3::UnitZ() + hand.v[5] * (yaw * Vec3::UnitY());
    const Vec3 beside = place.centre.value_or(start_.centre) - start_.centre;
    const double wider = place.aperture.value_or(start_.aperture) - start_.aperture;
    const Vec3 arm = R * (place.offset + (hand.x[3] + wider) / 2 * place.side);
    return {hand.x.head<3>() + beside + arm,
            hand.v.head<3>() + w.cross(arm) + hand.v[3] / 2 * (R * place.side), R, w};
}

}  // namespace dihaptic::hand
