// Closed-form solutions for a two-finger grasp and for pressing on a surface, for checks and
// predictions.
#pragma once

#include <cmath>

#include "base/geometry.h"

namespace dihaptic::model {

/// Force of two springs in series stretched together by `x` [m]: the hand's k_hand and the
/// coupling's k [N/m]. A finger with a target x beyond a surface presses on it with this force
/// [N].
constexpr double series_spring_force(double x, double k_hand, double k) {
    return x * k_hand * k / (k_hand + k);
}

/// Stretch of the hand's and the coupling's springs in series under a force [m].
constexpr double series_spring_stretch(double force, double k_hand, double k) {
    return force * (k_hand + k) / (k_hand * k);
}

/// Mean position of two or more fingers, leaving out the first. `p_WP(i)`: position of finger i.
template <class Positions>
Vec3 opposing_point(size_t fingers, const Positions& p_WP) {
    Vec3 others = Vec3::Zero();
    for (size_t i = 1; i < fingers; ++i) others += p_WP(i);
    return others / static_cast<double>(fingers - 1);
}

/// Unit vector of the pinch between two or more fingers, from the first to the opposing point.
template <class Positions>
Vec3 grasp_axis(size_t fingers, const Positions& p_WP) {
    return (opposing_point(fingers, p_WP) - p_WP(0)).normalized();
}

/// Smallest grip force that holds a load with two digits: load / (2 mu) [N].
constexpr double minimum_grip(double load, double friction) {
    return load / (2 * friction);
}

/// Force on each of two digits that hold a load with the minimum grip: the magnitude of the normal
/// force and half the load combined [N].
inline double smallest_hold(double load, double friction) {
    return std::hypot(minimum_grip(load, friction), load / 2);
}

/// Ratio of grip to load force below which two digits slip: 1 / (2 mu).
constexpr double slip_ratio(double friction) {
    return minimum_grip(1, friction);
}

/// Fraction of a grip force that exceeds the minimum for the load: (grip - minimum) / grip. If this
/// is negative, the load slips.
constexpr double safety_margin(double grip, double load, double friction) {
    return (grip - minimum_grip(load, friction)) / grip;
}

/// Grip force that holds a load with a given safety margin, which is below 1: minimum / (1 -
/// margin) [N].
constexpr double grip_with_margin(double load, double friction, double margin) {
    return minimum_grip(load, friction) / (1 - margin);
}

/// Highest stiffness of a sampled spring, held over intervals h, that is passive on a handle
/// with damping b: 2 b / h (Colgate and Schenkel 1997, no virtual damping) [N/m].
constexpr double passive_stiffness(double b, double h) {
    return 2 * b / h;
}

}  // namespace dihaptic::model
