#include "task/file/motor.h"

#include <fmt/format.h>

namespace dihaptic::task {
namespace {

bool goes_somewhere(const MotorSpec& spec) {
    return spec.angle || spec.displacement;
}
bool has_times(const MotorSpec& spec) {
    return spec.duration || spec.delay != 0;
}
bool is_limited(const MotorSpec& spec) {
    return spec.most_force || spec.most_torque;
}

/// Checks that the keys of a motor fit the kind of its joint.
void check_kind(const MotorSpec& spec, const scene::Joint& joint, Diagnostics& diagnostics) {
    const bool slides = joint.slides();
    const auto refuse = [&](bool given, const char* key, const char* what, const char* other) {
        if (given)
            diagnostics.error(spec.place, key, fmt::format("{} a {}", what, enum_name(joint.kind)),
                              fmt::format("Give {} instead.", other));
    };
    const char* const has = "is not the coordinate of";
    const char* const moves = "does not act on";
    refuse(slides && spec.angle, "angle", has, "displacement_mm");
    refuse(!slides && spec.displacement, "displacement", has, "angle_deg");
    refuse(slides && spec.most_torque, "most_torque", moves, "most_force_N");
    refuse(!slides && spec.most_force, "most_force", moves, "most_torque_Nm");
}

/// Checks that a motor that follows a course has a destination, a duration and a force limit.
void check_form(const MotorSpec& spec, const scene::Joint& joint, Diagnostics& diagnostics) {
    const auto error = [&](const char* key, const std::string& problem, const std::string& remedy) {
        diagnostics.error(spec.place, key, problem, remedy);
    };
    const char* const to = joint.slides() ? "displacement" : "angle";
    const bool goes = goes_somewhere(spec);
    const bool follows = !spec.follow.empty();
    if (goes && follows)
        error(to, "gives a second course, besides 'follow'", "Keep either this key or 'follow'.");
    if (!goes && !follows && spec.push.empty())
        error(to, "is missing, and so are 'follow' and 'push'",
              "Give the joint a destination, or a force or torque.");
    if (goes && !spec.duration) error("duration", "is missing", "Add e.g. duration_s: 0.8.");
    if (!goes && has_times(spec))
        error("duration", fmt::format("is only for a motor with {}", to),
              "Put the timing into the expressions, e.g. with time_in_state.");
    if ((goes || follows) && !is_limited(spec))
        error(joint.slides() ? "most_force" : "most_torque", "is missing",
              "Limit the motor: a hand in its way then feels no more than this limit.");
}

}  // namespace

Motor::Motor(const MotorSpec& spec, const scene::Joint& joint, int index, Quantities& quantities,
             Diagnostics& diagnostics)
    : joint_(index), goes_(goes_somewhere(spec)) {
    course_ = {spec.delay, spec.duration.value_or(0), spec.shape};
    check_kind(spec, joint, diagnostics);
    check_form(spec, joint, diagnostics);
    if (goes_) to_ = spec.angle ? *spec.angle : *spec.displacement;
    if (is_limited(spec)) most_ = spec.most_force ? *spec.most_force : *spec.most_torque;
    const auto compiled = [&](const std::string& text, Quantity quantity, const char* key,
                              const std::string& what) {
        return Expression::compile_of(quantity, what.c_str(), text, quantities, spec.place, key,
                                      "Write the " + what + " with its unit.", diagnostics);
    };
    if (joint.slides()) {
        follow_ = compiled(spec.follow, Quantity::length, "follow", "length");
        push_ = compiled(spec.push, Quantity::force, "push", "force");
    } else {
        follow_ = compiled(spec.follow, Quantity::angle, "follow", "angle");
        push_ = compiled(spec.push, Quantity::torque, "push", "torque");
    }
}

}  // namespace dihaptic::task
