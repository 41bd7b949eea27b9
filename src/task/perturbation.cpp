#include "task/perturbation.h"

namespace dihaptic::task {

Perturbation::Perturbation(const PerturbationSpec& spec, const std::vector<Region>& regions,
                           const scene::Scene& scene, Diagnostics& diagnostics) {
    if (spec.visual) visual_.emplace(*spec.visual, regions, scene, diagnostics);
    if (spec.body) body_.emplace(*spec.body, scene, diagnostics);
    if (spec.joint) joint_.emplace(*spec.joint, scene, diagnostics);
    for (const LoadSpec& load : spec.all_loads())
        loads_.emplace_back(load, regions, scene, diagnostics);
    profile_ = spec.profile;
    if (profile_ && profile_->fall > 0 && !profile_->plateau) {
        diagnostics.error(profile_->place, "fall", "when it falls is missing",
                          "Add e.g. plateau_ms: 100, the time between rise and fall.");
    }
    bool any = false;
    spec.each_effect([&](const auto&) { any = true; });
    if (!any) {
        diagnostics.error(spec.place, spec.name, "perturbs nothing",
                          "Give it visual, body, joint, loads or field.");
    }
}

std::optional<frame::PropertiesFrame> Perturbation::properties() const {
    if (!body_) return {};
    return body_->properties();
}

Mat3 Perturbation::field_gain() const {
    Mat3 gain = Mat3::Zero();
    for (const Load& load : loads_) gain += load.velocity_gain();
    return gain;
}

std::optional<Vec3> Perturbation::axis() const {
    if (visual_ && visual_->axis()) return visual_->axis();
    for (const Load& load : loads_) {
        if (const auto axis = load.axis()) return axis;
    }
    return {};
}

void Perturbation::order(double share, std::span<const Vec3> regions_W, const Motions& motions,
                         frame::TaskFrame& out) const noexcept {
    each_effect(*this, [&](const auto& effect) { effect.order(share, regions_W, motions, out); });
}

}  // namespace dihaptic::task
