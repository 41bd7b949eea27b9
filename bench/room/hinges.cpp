#include "bench/hinges.h"

#include <fmt/format.h>

#include "base/diagnostics.h"

namespace dihaptic::bench {

std::vector<Hinge> hinges_of(const scene::Scene& scene) {
    std::vector<Hinge> out;
    std::vector<bool> hangs(scene.bodies.size(), false);
    for (const scene::Joint& joint : scene.joints) {
        if (joint.kind != scene::JointKind::hinge || joint.has_spring() || joint.has_damper() ||
            joint.friction > 0 || joint.low || joint.high)
            throw Error(
                fmt::format("Joint {} is not a plain hinge, but peers get only plain hinges",
                            joint.name),
                "Use plain hinges.");
        Hinge hinge;
        hinge.body = static_cast<size_t>(scene.find(joint.between.back()));
        if (joint.between.size() == 2)
            hinge.parent = static_cast<size_t>(scene.find(joint.between.front()));
        hinge.p_W = joint.position;
        hinge.axis_W = joint.axis.normalized();
        if (hangs[hinge.body])
            throw Error(fmt::format("{} hangs on two hinges", joint.between.back()),
                        "Peers get only trees.");
        if (hinge.parent && !hangs[*hinge.parent])
            throw Error(fmt::format("{} comes before its parent", joint.name),
                        "Start with the hinge joined to the world.");
        hangs[hinge.body] = true;
        out.push_back(hinge);
    }
    return out;
}

Pose frame_of(const Hinge& hinge) {
    return {Quat::FromTwoVectors(Vec3::UnitZ(), hinge.axis_W), hinge.p_W};
}

}  // namespace dihaptic::bench
