// Closed-form solutions for a two-finger grasp and for pressing on a surface, used for checks and
// predictions.
#pragma once

#include <cmath>

#include "base/geometry.h"

namespace dihaptic::model {

/// Force of two springs in series, the hand's (k_hand) and the coupling's (k) [N/m], that are
/// stretched by `x` in total [m]. A finger whose target lies x beyond a surface presses on the
/// surface with this force [N].
constexpr double series_spring_force(double x, double k_hand, double k) {
    return x * k_hand * k / (k_hand + k);
}

/// Total stretch of the hand's and the coupling's springs, in series, under a force [m].
constexpr double series_spring_stretch(double force, double k_hand, double k) {
    return force * (k_hand + k) / (k_hand * k);
}

/// Mean position of all fingers except the first; there must be at least two. `p_WP(i)`: position
/// of finger i.
template <class Positions>
Vec3 opposing_point(size_t fingers, const Positions& p_WP) {
    Vec3 others = Vec3::Zero();
    for (size_t i = 1; i < fingers; ++i) others += p_WP(i);
    return others / static_cast<double>(fingers - 1);
}

/// Unit vector of a pinch between two or more fingers, pointing from the first finger to the mean
/// position of the others.
template <class Positions>
Vec3 grasp_axis(size_t fingers, const Positions& p_WP) {
    return (opposing_point(fingers, p_WP) - p_WP(0)).normalized();
}

/// Smallest grip force with which two digits can hold a load: load / (2 mu) [N].
constexpr double minimum_grip(double load, double friction) {
    return load / (2 * friction);
}

/// Force on each of two digits that hold a load with the minimum grip force: the magnitude of the
/// normal force combined with half of the load [N].
inline double smallest_hold(double load, double friction) {
    return std::hypot(minimum_grip(load, friction), load / 2);
}

/// Ratio of grip to load force below which two digits slip: 1 / (2 mu).
constexpr double slip_ratio(double friction) {
    return minimum_grip(1, friction);
}

/// Fraction of the grip force that exceeds the minimum for the load: (grip - minimum) / grip. If
/// negative, the load slips.
constexpr double safety_margin(double grip, double load, double friction) {
    return (grip - minimum_grip(load, friction)) / grip;
}

/// Grip force that holds a load with a given safety margin, which must be below 1: minimum / (1 -
/// margin) [N].
constexpr double grip_with_margin(double load, double friction, double margin) {
    return minimum_grip(load, friction) / (1 - margin);
}

/// Highest passive stiffness of a sampled spring whose force is held over intervals h, on a handle
/// with damping b: 2 b / h (Colgate and Schenkel 1997, without virtual damping) [N/m].
constexpr double passive_stiffness(double b, double h) {
    return 2 * b / h;
}

}  // namespace dihaptic::model
