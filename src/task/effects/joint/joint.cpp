#include "task/effects/joint/joint.h"

#include <algorithm>

namespace dihaptic::task {

JointEffect::JointEffect(const JointSpec& spec, const Names&, const scene::Scene& scene,
                         Diagnostics& diagnostics)
    : spec_(spec) {
    if (spec.joint.index < 0) return;
    const scene::Joint& joint = scene.joints[static_cast<size_t>(spec.joint.index)];
    const auto needs = [&](const Formula& factor, const char* key, bool there, const char* what) {
        if (factor == 1 || there) return;
        diagnostics.error(spec.place, key, "'" + spec.joint + "' has no " + what + " to change",
                          std::string("Give the joint a ") + what +
                              " in the scene, to which this factor applies.");
    };
    needs(spec.stiffness_scale, "stiffness_scale", joint.has_spring(), "stiffness");
    needs(spec.damping_scale, "damping_scale", joint.has_damper(), "damping");
    needs(spec.friction_scale, "friction_scale", joint.friction > 0, "friction");
}

void JointEffect::order(double share, std::span<const Vec3>, const Motions&,
                        frame::TaskFrame& out) const noexcept {
    const frame::JointPropertiesFrame now{
        spec_.joint.index, part_of(share, spec_.stiffness_scale.value),
        part_of(share, spec_.damping_scale.value), part_of(share, spec_.friction_scale.value)};
    const auto same = std::find_if(out.joint_properties.begin(), out.joint_properties.end(),
                                   [&](const auto& other) { return other.joint == now.joint; });
    if (same == out.joint_properties.end()) return add(out.joint_properties, now);
    same->stiffness_scale *= now.stiffness_scale;
    same->damping_scale *= now.damping_scale;
    same->friction_scale *= now.friction_scale;
}

void say(const JointSpec& spec, std::vector<std::string>& out) {
    say_factor("stiffness of " + spec.joint, spec.stiffness_scale, out);
    say_factor("damping of " + spec.joint, spec.damping_scale, out);
    say_factor("friction of " + spec.joint, spec.friction_scale, out);
}

}  // namespace dihaptic::task
