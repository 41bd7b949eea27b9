#include "task/effects/body/body.h"

#include <algorithm>

namespace dihaptic::task {

BodyEffect::BodyEffect(const BodySpec& spec, const Names&, const scene::Scene& scene,
                       Diagnostics& diagnostics)
    : spec_(spec) {
    if (spec.body.index < 0) return;
    const scene::Body& body = scene.bodies[static_cast<size_t>(spec.body.index)];
    const bool only_surface =
        spec.mass_scale == kNoFactors && spec.weight_scale == 1 && spec.density_scale == 1;
    if (!only_surface && !body.moves_at_all()) {
        diagnostics.error(spec.place, "body", "'" + spec.body + "' cannot move",
                          "Name a movable body, or change only this body's friction and surface.");
    }
    const auto needs = [&](const Formula& factor, const char* key, bool there, const char* what) {
        if (factor == 1 || there) return;
        diagnostics.error(spec.place, key, "'" + spec.body + "' has no " + what + " to change",
                          std::string("Add it in the scene: surface: { ") + what + ": ... }.");
    };
    needs(spec.stiffness_scale, "stiffness_scale", body.surface.stiffness.has_value(),
          "stiffness_N_m");
    needs(spec.restitution_scale, "restitution_scale", body.surface.restitution.has_value(),
          "restitution");
    const auto& texture = body.surface.texture;
    const char* const kTexture = "texture";
    needs(spec.texture_wavelength_scale, "texture_wavelength_scale", texture.has_value(), kTexture);
    needs(spec.texture_height_scale, "texture_height_scale", texture && texture->height > 0,
          "texture: { height_mm }");
    needs(spec.texture_friction_scale, "texture_friction_scale", texture && texture->friction > 0,
          "texture: { friction }");
}

frame::PropertiesFrame BodyEffect::properties() const noexcept {
    const double density = spec_.density_scale.value;
    return {spec_.body.index,
            density * value(spec_.mass_scale),
            density * spec_.weight_scale.value,
            density,
            spec_.friction_scale.value,
            spec_.stiffness_scale.value,
            spec_.restitution_scale.value,
            spec_.texture_wavelength_scale.value,
            spec_.texture_height_scale.value,
            spec_.texture_friction_scale.value};
}

void BodyEffect::order(double share, std::span<const Vec3>, const Motions&,
                       frame::TaskFrame& out) const noexcept {
    frame::PropertiesFrame now = properties();
    now.mass_scale = part_of(share, now.mass_scale);
    for (double* factor :
         {&now.weight_scale, &now.turning_scale, &now.friction_scale, &now.stiffness_scale,
          &now.restitution_scale, &now.texture_wavelength_scale, &now.texture_height_scale,
          &now.texture_friction_scale})
        *factor = part_of(share, *factor);
    const auto same = std::find_if(out.properties.begin(), out.properties.end(),
                                   [&](const auto& other) { return other.body == now.body; });
    if (same == out.properties.end()) return add(out.properties, now);
    same->mass_scale = same->mass_scale.cwiseProduct(now.mass_scale);
    same->weight_scale *= now.weight_scale;
    same->turning_scale *= now.turning_scale;
    same->friction_scale *= now.friction_scale;
    same->stiffness_scale *= now.stiffness_scale;
    same->restitution_scale *= now.restitution_scale;
    same->texture_wavelength_scale *= now.texture_wavelength_scale;
    same->texture_height_scale *= now.texture_height_scale;
    same->texture_friction_scale *= now.texture_friction_scale;
}

void say(const BodySpec& spec, std::vector<std::string>& out) {
    if (spec.mass_scale != kNoFactors) out.push_back("inertia times " + in_words(spec.mass_scale));
    say_factor("weight", spec.weight_scale, out);
    say_factor("density", spec.density_scale, out);
    say_factor("friction", spec.friction_scale, out);
    say_factor("stiffness", spec.stiffness_scale, out);
    say_factor("restitution", spec.restitution_scale, out);
    say_factor("wavelength of its texture", spec.texture_wavelength_scale, out);
    say_factor("height of its texture", spec.texture_height_scale, out);
    say_factor("friction of its texture", spec.texture_friction_scale, out);
}

}  // namespace dihaptic::task
