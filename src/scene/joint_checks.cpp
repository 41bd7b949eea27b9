#include "scene/joint_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/unit.h"

namespace dihaptic::scene {
namespace {

/// Checks that the two points of a distance joint are apart.
void check_points(const Joint& joint, Diagnostics& diagnostics) {
    if (joint.is_distance() != joint.second_position.has_value()) {
        diagnostics.error(joint.place, "second_position",
                          joint.is_distance() ? "is missing" : "belongs to a distance joint",
                          joint.is_distance() ? "Give the second body's point at the start."
                                              : "Leave it out, or set kind: distance.");
    } else if (joint.is_rod() && (*joint.second_position - joint.position).norm() < 1e-9) {
        diagnostics.error(joint.place, "second_position",
                          "is the same point, so the rod has no direction",
                          "Move it, or set kind: ball.");
    }
}

/// Checks that a bushing, and no other joint, has stiffnesses or dampings for its axes.
void check_bushing(const Joint& joint, Diagnostics& diagnostics) {
    const bool bushes = !joint.stiffnesses.isZero(0) || !joint.turn_stiffnesses.isZero(0) ||
                        !joint.dampings.isZero(0) || !joint.turn_dampings.isZero(0);
    if (bushes != joint.row().yields)
        diagnostics.error(joint.place, "stiffnesses",
                          bushes ? fmt::format("belongs to a bushing joint, not to a {} joint",
                                               enum_name(joint.kind))
                                 : "is missing",
                          bushes ? "Give a single stiffness, or set kind: bushing."
                                 : "Add e.g. stiffnesses_N_m: [500, 500, 2000].");
}

/// Checks that the points of a curve are in ascending order, and that no segment is steeper than
/// the stiffest spring allowed.
void check_curve(const Joint& joint, Diagnostics& diagnostics) {
    const SpringCurve& curve = joint.curve;
    if (curve.stretch.empty() && curve.resistance.empty()) return;
    const char* const example = "Write e.g. curve_at_mm: [-10, 0, 10] and curve_N: [-2, 0, 5].";
    const size_t points = curve.stretch.size();
    if (points < 2 || points != curve.resistance.size()) {
        diagnostics.error(
            joint.place, points < 2 ? "curve_at" : "curve",
            fmt::format("has {} stretches and {} resistances, but needs two or more of "
                        "each",
                        points, curve.resistance.size()),
            example);
        return;
    }
    if (joint.stiffness > 0)
        diagnostics.error(joint.place, "stiffness",
                          "cannot be combined with a curve, which is a spring itself",
                          "Leave out one of the two.");
    for (size_t i = 1; i < points; ++i) {
        const double way = curve.stretch[i] - curve.stretch[i - 1];
        if (!(way > 0)) {
            diagnostics.error(joint.place, "curve_at", "does not ascend", example);
            return;
        }
        if (std::abs(curve.resistance[i] - curve.resistance[i - 1]) <= Joint::kStiffest * way)
            continue;
        diagnostics.error(joint.place, "curve",
                          fmt::format("has a segment steeper than {:g} {}", Joint::kStiffest,
                                      joint.slides() ? "N/m" : "N*m/rad"),
                          "Model a wall as a stop (low, high).");
    }
}

/// Checks that a joint with springs, dampers, friction or stops has a free axis to which they
/// apply.
void check_axis(const Joint& joint, Diagnostics& diagnostics) {
    const bool asks = joint.has_axis_spring() || joint.damping > 0 || joint.friction > 0 ||
                      joint.low || joint.high;
    if (asks && !joint.has_coordinate()) {
        diagnostics.error(
            joint.place, joint.name,
            fmt::format("has a spring, damper, friction or stop, but a {} joint has no "
                        "single axis for it",
                        enum_name(joint.kind)),
            joint.row().yields
                ? "Give stiffnesses and dampings for each axis."
                : fmt::format("Leave it out, or set kind: {}.",
                              kinds_that(&JointKindRow::has_coordinate, &JointKindRow::name)));
    }
    constexpr double kShort = 1e-9;
    if (joint.axis.norm() < kShort)
        diagnostics.error(joint.place, "axis", "has no direction", "Write e.g. axis: [0, 0, 1].");
    if (joint.row().turning == Turning::about_two_axes &&
        joint.axis.cross(joint.second_axis).norm() <
            kShort * joint.axis.norm() * joint.second_axis.norm())
        diagnostics.error(joint.place, "second_axis", "lies along the first axis",
                          "Set it at an angle to the first axis, ideally a right angle.");
    if (joint.low && joint.high && *joint.low > *joint.high)
        diagnostics.error(joint.place, "low", "is above 'high', so that no position is allowed",
                          "Exchange the two.");
}

/// Warns about a joint that starts beyond its stops, because this would hurl the joined bodies
/// away.
void check_start(const Joint& joint, Diagnostics& diagnostics) {
    if (!joint.has_coordinate()) return;
    double start = 0;
    if (joint.is_distance() && joint.second_position)
        start = (*joint.second_position - joint.position).norm();
    constexpr double kSlack = 1e-9;
    const bool below = joint.low && start < *joint.low - kSlack;
    if (!below && !(joint.high && start > *joint.high + kSlack)) return;
    const double unit = joint.slides() ? 1e-3 : kDegree;
    diagnostics.warning(
        joint.place, below ? "low" : "high",
        fmt::format("{} starts at {:.4g} {}, beyond its stop at {:.4g}", joint.name, start / unit,
                    joint.slides() ? "mm" : "deg", (below ? *joint.low : *joint.high) / unit),
        "Start within its stops; otherwise the first tick would hurl the joined bodies.");
}

/// Warns about joined bodies whose masses differ so much that rounding affects the motion of the
/// lighter one.
void check_masses(const Joint& joint, const Scene& scene, Diagnostics& diagnostics) {
    constexpr double kApart = 1e6;
    if (joint.between.size() != 2) return;
    double masses[2];
    for (size_t i = 0; i < 2; ++i) {
        const int body = scene.find(joint.between[i]);
        if (body < 0 || !scene.bodies[static_cast<size_t>(body)].moves_at_all()) return;
        masses[i] = mass(scene.bodies[static_cast<size_t>(body)]);
    }
    const auto [light, heavy] = std::minmax(masses[0], masses[1]);
    if (!(light > 0) || heavy < kApart * light) return;
    diagnostics.warning(
        joint.place, joint.name,
        fmt::format("joins {:.3g} kg to {:.3g} kg, a ratio above {:g}", light, heavy, kApart),
        "Check the units of their masses.");
}

void check_between(const Joint& joint, const Scene& scene, Diagnostics& diagnostics) {
    if (joint.between.empty() || joint.between.size() > 2) {
        diagnostics.error(joint.place, "between", "must contain one or two bodies",
                          "Write between: [cart, bob], or between: [door] for a joint to the "
                          "world.");
        return;
    }
    bool moves = false;
    bool known = true;
    for (const std::string& name : joint.between) {
        const int body = scene.find(name);
        known = known && body >= 0;
        moves = moves || (body >= 0 && scene.bodies[static_cast<size_t>(body)].moves_at_all());
        if (body >= 0) continue;
        report_unknown_body(name, scene, joint.place, "between", diagnostics);
    }
    if (joint.between.front() == joint.between.back() && joint.between.size() == 2) {
        diagnostics.error(joint.place, "between",
                          fmt::format("'{}' cannot be joined to itself", joint.between[0]),
                          "Name two different bodies.");
    } else if (known && !moves) {
        diagnostics.error(joint.place, "between", "joins no body that can move",
                          "Name a movable body, or leave the joint out.");
    }
}

}  // namespace

void check_joints(const Scene& scene, Diagnostics& diagnostics) {
    for (const Joint& joint : scene.joints) {
        check_axis(joint, diagnostics);
        check_curve(joint, diagnostics);
        check_bushing(joint, diagnostics);
        check_points(joint, diagnostics);
        check_start(joint, diagnostics);
        check_masses(joint, scene, diagnostics);
        check_between(joint, scene, diagnostics);
    }
}

}  // namespace dihaptic::scene
