#include "task/effects/perturbation.h"

#include "task/file/hed.h"

namespace dihaptic::task {

Perturbation::Perturbation(const PerturbationSpec& spec, const Names& names,
                           const scene::Scene& scene, Diagnostics& diagnostics) {
    bool any = false;
    spec.each_effect([&]<class Spec>(const Spec& effect) {
        std::get<std::vector<typename Spec::Effect>>(effects_).emplace_back(effect, names, scene,
                                                                            diagnostics);
        any = true;
    });
    profile_ = spec.profile;
    if (profile_ && profile_->fall != 0 && !profile_->plateau) {
        diagnostics.error(profile_->place, "fall", "has no effect without a plateau",
                          "Add e.g. plateau_ms: 100, the time between rise and fall.");
    }
    check_hed(spec.hed, spec.place, diagnostics);
    if (!any) {
        diagnostics.error(spec.place, spec.name, "perturbs nothing",
                          "Give it 'visual', 'body', 'joint', 'loads' or 'field'.");
    }
}

std::optional<frame::PropertiesFrame> Perturbation::properties() const {
    if (of<BodyEffect>().empty()) return {};
    return of<BodyEffect>()[0].properties();
}

Mat3 Perturbation::field_gain() const {
    Mat3 gain = Mat3::Zero();
    for (const Load& load : loads()) gain += load.velocity_gain();
    return gain;
}

double Perturbation::field_delay() const {
    const std::span<const Load> all = loads();
    const auto moved =
        std::ranges::find_if(all, [](const Load& load) { return !load.velocity_gain().isZero(0); });
    return moved == all.end() ? 0 : moved->delay();
}

std::optional<Vec3> Perturbation::axis() const {
    for (const VisualEffect& map : of<VisualEffect>()) {
        if (const auto axis = map.axis()) return axis;
    }
    for (const Load& load : loads()) {
        if (const auto axis = load.axis()) return axis;
    }
    return {};
}

void Perturbation::order(double share, std::span<const Vec3> regions_W, const Motions& motions,
                         frame::TaskFrame& out) const noexcept {
    each_effect(*this, [&](const auto& effect) { effect.order(share, regions_W, motions, out); });
}

}  // namespace dihaptic::task
