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

/// The keys of a motor are of the kind of its joint.
void check_kind(const MotorSpec& spec, const scene::Joint& joint, Diagnostics& diagnostics) {
    const bool slides = joint.slides();
    const auto refuse = [&](bool given, const char* key, const char* what, const char* other) {
        if (given)
            diagnostics.error(spec.place, key, fmt::format("{} a {}", what, enum_name(joint.kind)),
                              fmt::format("Give {} in its place.", other));
    };
    const char* const has = "is not the coordinate of";
    const char* const moves = "is not what moves";
    refuse(slides && spec.angle, "angle", has, "displacement_mm");
    refuse(!slides && spec.displacement, "displacement", has, "angle_deg");
    refuse(slides && spec.most_torque, "most_torque", moves, "most_force_N");
    refuse(!slides && spec.most_force, "most_force", moves, "most_torque_Nm");
}

/// A motor that takes its joint somewhere knows where to, when and how hard.
void check_form(const MotorSpec& spec, const scene::Joint& joint, Diagnostics& diagnostics) {
    const auto error = [&](const char* key, const std::string& problem, const std::string& remedy) {
        diagnostics.error(spec.place, key, problem, remedy);
    };
    const char* const to = joint.slides() ? "displacement" : "angle";
    const bool goes = goes_somewhere(spec);
    const bool follows = !spec.follow.empty();
    if (goes && follows) error(to, "leads two ways at once", "Keep this or follow.");
    if (!goes && !follows && spec.push.empty())
        error(to, "is missing, and so are follow and push",
              "Say where the joint goes, or with what it is pushed.");
    if (goes && !spec.duration) error("duration", "is missing", "Add e.g. duration_s: 0.8.");
    if (!goes && has_times(spec))
        error("duration", fmt::format("belongs to {}", to),
              "Let the expressions say when, e.g. with time_in_state.");
    if ((goes || follows) && !is_limited(spec))
        error(joint.slides() ? "most_force" : "most_torque", "is missing",
              "Say how hard the motor may press: a hand that is in its way feels no more.");
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
                                      "Write a " + what + " with its unit.", diagnostics);
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
