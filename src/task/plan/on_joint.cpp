#include "task/plan/on_joint.h"

#include <fmt/format.h>

#include "task/file/task.h"

namespace dihaptic::task {

Pose OnJoint::pose(const Pose& X_WA_then, double q) const noexcept {
    Pose moved = X_WB;
    if (slides) {
        moved.p += q * axis_W;
    } else {
        const Quat turn(Eigen::AngleAxisd(q, axis_W));
        moved = {turn * X_WB.R, p_W + turn * (X_WB.p - p_W)};
    }
    return X_WA_then * (X_WA.inverse() * moved);
}

BodyMotion OnJoint::motion(const Pose& X_WA_then, const BodyMotion& of_a, const Pose& X_WB_then,
                           double rate) const noexcept {
    const Pose moved = X_WA_then * X_WA.inverse();
    const Vec3 along = moved.R * axis_W * rate;
    BodyMotion out{of_a.v + of_a.w.cross(X_WB_then.p - X_WA_then.p), of_a.w};
    if (slides) {
        out.v += along;
    } else {
        out.v += along.cross(X_WB_then.p - moved * p_W);
        out.w += along;
    }
    return out;
}

OnJoint on_joint(const scene::Scene& scene, const scene::Joint& joint) {
    const bool to_world = joint.between.size() == 1;
    const auto body = [&](size_t i) { return scene.find(joint.between[i]); };
    OnJoint out;
    out.first = to_world ? -1 : body(0);
    out.slides = joint.slides();
    out.p_W = joint.position;
    out.axis_W = joint.axis.normalized();
    if (!to_world) out.X_WA = scene.bodies[static_cast<size_t>(out.first)].pose();
    out.X_WB = scene.bodies[static_cast<size_t>(body(to_world ? 0 : 1))].pose();
    return out;
}

namespace {

/// Checks a placement that does not use a joint.
void check_body(const BodyPlace& place, Diagnostics& diagnostics) {
    const auto refuse_key = [&](const char* key, bool given) {
        if (given)
            diagnostics.error(place.place, key, "is only for a joint, but none is named",
                              "Add the name of a joint, e.g. joint: hinge.");
    };
    refuse_key("angle", place.angle.has_value());
    refuse_key("displacement", place.displacement.has_value());
    refuse_key("rate", place.rate != 0);
    refuse_key("speed", place.speed != 0);
    if (place.body.empty() || !place.position)
        diagnostics.error(place.place, place.body.empty() ? "body" : "position", "is missing",
                          "Name a body and its position_mm, or a joint and its angle_deg or "
                          "displacement_mm.");
}

void check_coordinate(const BodyPlace& place, const scene::Joint& joint, Diagnostics& diagnostics) {
    using Kind = scene::JointKindRow;
    if (!joint.row().has_axis()) {
        diagnostics.error(place.place, "joint",
                          fmt::format("'{}' has no axis: it is neither {}", joint.name,
                                      scene::kinds_that(&Kind::has_axis, &Kind::noun, " nor ")),
                          fmt::format("Name {}, or place the bodies of the joint.",
                                      scene::kinds_that(&Kind::has_axis)));
        return;
    }
    if (joint.slides() ? place.rate != 0 : place.speed != 0)
        diagnostics.error(
            place.place, joint.slides() ? "rate" : "speed",
            fmt::format("does not apply to a {}", enum_name(joint.kind)),
            fmt::format("Give {} instead.", joint.slides() ? "speed_mm_s" : "rate_deg_s"));
    if (place.velocity)
        diagnostics.error(place.place, "velocity", "is only for a body, but a joint is named",
                          "Give the joint's rate_deg_s or speed_mm_s.");
    const auto& own = joint.slides() ? place.displacement : place.angle;
    const auto& other = joint.slides() ? place.angle : place.displacement;
    if (own && !other) return;
    diagnostics.error(place.place, joint.slides() ? "displacement" : "angle",
                      fmt::format("is the only coordinate of a {}", enum_name(joint.kind)),
                      joint.slides() ? "Give displacement_mm alone." : "Give angle_deg alone.");
}

}  // namespace

void check_joint(const BodyPlace& place, const scene::Scene& scene, Diagnostics& diagnostics) {
    if (place.joint.empty()) {
        check_body(place, diagnostics);
        return;
    }
    if (!place.body.empty() || place.position)
        diagnostics.error(place.place, "joint",
                          "already determines the position of its second body",
                          "Keep either 'joint' or 'body'.");
    if (place.joint.index >= 0)
        check_coordinate(place, scene.joints[static_cast<size_t>(place.joint.index)], diagnostics);
}

}  // namespace dihaptic::task
