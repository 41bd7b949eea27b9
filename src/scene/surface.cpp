#include "scene/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/unit.h"
#include "scene/scene.h"

namespace dihaptic::scene {
namespace {

/// The larger of two optional values.
double larger(const std::optional<double>& a, const std::optional<double>& b) {
    return std::max(a.value_or(0), b.value_or(0));
}

/// Combines springs in series, each with a damper in parallel: f = k x + c dx/dt for slow motion.
void in_series(const Surface& a, const Surface& b, PairSurface& out) {
    double give = 0;  // 1 / k
    double lag = 0;   // c / k^2
    for (const Surface* one : {&a, &b}) {
        if (!one->stiffness) continue;
        const double k = *one->stiffness;
        give += 1 / k;
        lag += one->damping.value_or(0) / (k * k);
    }
    if (give == 0) return;
    out.stiffness = 1 / give;
    out.damping = lag / (give * give);
}

}  // namespace

double PairSurface::friction_at(double speed, double normal_force) const noexcept {
    const double share = speed / stribeck_speed;
    double mu = dynamic_friction + (friction - dynamic_friction) * std::exp(-share * share);
    if (film > 0 && normal_force > 0) mu += film * speed / normal_force;
    return std::min(mu, kMostFriction);
}

PairSurface pair_surface(const Scene& scene, const SurfaceOf& a, const SurfaceOf& b) {
    PairSurface out;
    out.friction = pair_friction(scene, a.name, a.friction, b.name, b.friction);
    in_series(a.surface, b.surface, out);
    out.restitution = larger(a.surface.restitution, b.surface.restitution);
    out.film = a.surface.film.value_or(0) + b.surface.film.value_or(0);
    const auto sliding = [](const SurfaceOf& of) {
        return of.surface.dynamic_friction.value_or(of.friction);
    };
    out.dynamic_friction = std::sqrt(sliding(a) * sliding(b));
    const auto& v_a = a.surface.stribeck_speed;
    const auto& v_b = b.surface.stribeck_speed;
    if (v_a || v_b)
        out.stribeck_speed = (v_a.value_or(v_b.value_or(0)) + v_b.value_or(v_a.value_or(0))) / 2;
    if (const Pair* pair = find_pair(scene, a.name, b.name); pair != nullptr) {
        const Surface& own = pair->surface;
        if (own.stiffness) in_series(own, {}, out);
        if (own.restitution) out.restitution = *own.restitution;
        if (own.film) out.film = *own.film;
        if (own.stribeck_speed) out.stribeck_speed = *own.stribeck_speed;
        if (own.dynamic_friction) {
            out.dynamic_friction = *own.dynamic_friction;
        } else if (pair->friction) {
            out.dynamic_friction = out.friction;  // the pair gives only one coefficient
        }
    }
    out.dynamic_friction = std::min(out.dynamic_friction, out.friction);
    return out;
}

namespace {

void check(const Texture& texture, Diagnostics& diagnostics) {
    if (texture.along.norm() < 1e-9)
        diagnostics.error(texture.place, "along", "has no direction",
                          "Write e.g. along: [1, 0, 0].");
    if (texture.kind == TextureKind::picture && texture.file.empty())
        diagnostics.error(texture.place, "file", "is missing", "Give the name of a PNG file.");
    if (texture.kind != TextureKind::picture && !texture.file.empty())
        diagnostics.error(texture.place, "file", "applies only to pictures", "Set kind: picture.");
    if (texture.friction == 0 && texture.height == 0)
        diagnostics.error(texture.place, "friction", "is missing, and so is height",
                          "Add e.g. friction: 0.5, or height_mm: 0.1.");
    if (texture.steepest() > Texture::kSteepest)
        diagnostics.error(
            texture.place, "height",
            fmt::format("gives slopes of {:.3g} degrees, too steep for a finger to slide",
                        std::atan(texture.steepest()) / kDegree),
            fmt::format("For 45 degrees make it at most {:.3g} mm at this wavelength.",
                        1e3 * texture.height * Texture::kSteepest / texture.steepest()));
}

}  // namespace

void check(const Surface& surface, std::optional<double> friction, Diagnostics& diagnostics) {
    if (surface.texture) check(*surface.texture, diagnostics);
    if (surface.damping && !surface.stiffness)
        diagnostics.error(surface.place, "damping", "needs a stiffness, but the face is rigid",
                          "Add stiffness_N_m, or leave the damping out.");
    if (surface.stiffness && surface.restitution)
        diagnostics.error(
            surface.place, "restitution", "cannot be combined with a stiffness",
            "Keep one of the two: the bounce of a soft face follows from its damping.");
    if (surface.dynamic_friction && friction && *surface.dynamic_friction > *friction)
        diagnostics.error(surface.place, "dynamic_friction",
                          fmt::format("is above the static coefficient of {:g}", *friction),
                          "Lower it, or raise friction.");
}

}  // namespace dihaptic::scene
