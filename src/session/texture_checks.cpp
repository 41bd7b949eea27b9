#include "session/texture_checks.h"

#include <fmt/format.h>

#include <map>
#include <numbers>
#include <set>

#include "session/proxies.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::session {
namespace {

using scene::Texture;

constexpr double kSpeed = 0.25;  // speed of a hand that explores a surface [m/s]

class TextureChecks {
  public:
    TextureChecks(const Plan& plan, Diagnostics& diagnostics)
        : plan_(plan),
          diagnostics_(diagnostics),
          way_(kSpeed * plan.settings.dynamics.every / plan.settings.rate) {}

    void check() {
        const bool apart = any_finger(plan_, scene::ProxyKind::point) &&
                           plan_.settings.proxy.friction == frame::PointFriction::apart;
        for (const scene::Body& body : plan_.scene.bodies) {
            if (!body.surface.texture || body.surface.texture->height == 0) continue;
            const Texture& texture = *body.surface.texture;
            check_ridges(body.name, texture, texture.place, "");
            if (apart)
                diagnostics_.warning(
                    texture.place, "height",
                    "if its friction is separate from the dynamics, a point does not feel heights",
                    "Use proxy: friction: together.");
        }
        if (plan_.task) check_trials();
    }

  private:
    /// Checks the textures in each trial, as changed by the trial's perturbations.
    void check_trials() {
        task::each_trial(*plan_.task, [&](size_t t, const task::TrialNumbers& numbers) {
            std::map<int, frame::PropertiesFrame> all;  // indexed by body; factors multiply
            for (const int p : plan_.task->trials[t].perturb) {
                const task::PerturbationSpec& spec =
                    plan_.task->task.perturbations[static_cast<size_t>(p)];
                const auto changed =
                    numbers.cell().perturbations[static_cast<size_t>(p)].properties();
                if (!changed || !spec.body) continue;
                frame::PropertiesFrame& together = all[changed->body];
                together.body = changed->body;
                together.texture_wavelength_scale *= changed->texture_wavelength_scale;
                together.texture_height_scale *= changed->texture_height_scale;
                together.texture_friction_scale *= changed->texture_friction_scale;
                check_changed(together, *spec.body, t);
            }
        });
    }

    /// Describes a trial; trials that depend on a procedure are checked at the limits of its
    /// levels.
    std::string in_trial(size_t trial) const {
        return fmt::format("in trial {}{}", trial + 1,
                           plan_.task->trials[trial].procedure < 0 ? "" : ", at some level,");
    }

    void check_changed(const frame::PropertiesFrame& changed, const task::BodySpec& spec,
                       size_t trial) {
        const scene::Body& body = plan_.scene.bodies[static_cast<size_t>(changed.body)];
        if (!body.surface.texture || changed.texture_height_scale == 0) return;
        const Texture& given = *body.surface.texture;
        if (given.height == 0) return;
        Texture texture = given;
        texture.scale(given, changed.texture_wavelength_scale, changed.texture_height_scale,
                      changed.texture_friction_scale);
        const double wanted = changed.texture_height_scale * given.height;
        if (texture.height < 0.9999 * wanted && limited_.insert(spec.place.line).second) {
            diagnostics_.warning(
                spec.place, "texture_height_scale",
                fmt::format("{} ridges of {} would be {:.3g} mm high: they are limited "
                            "to {:.3g} mm, since no slope may exceed 45 degrees and no ridge "
                            "{:g} mm",
                            in_trial(trial), body.name, 1e3 * wanted, 1e3 * texture.height,
                            1e3 * Texture::kHighest),
                "Lower it, or make the wavelength longer.");
        }
        if (texture.wavelength == given.wavelength && texture.height == given.height) return;
        if (!close_.contains(spec.place.line))
            check_ridges(body.name, texture, spec.place, in_trial(trial) + " ");
    }

    void check_ridges(const std::string& body, const Texture& texture, const Place& place,
                      const std::string& when) {
        // wavelength of a sinusoidal grating with this height and slope
        const double ridge = std::numbers::pi * texture.height / texture.steepest();
        if (ridge >= 4 * way_) return;
        diagnostics_.warning(
            place, when.empty() ? "wavelength" : "texture_wavelength_scale",
            fmt::format("{}at {:g} mm/s a step passes {:.2g} of {}'s ridges of {:.3g} mm: they "
                        "are felt as noise",
                        when, 1e3 * kSpeed, way_ / ridge, body, 1e3 * ridge),
            fmt::format("Make {} {:.3g} mm or more.", when.empty() ? "it" : "the wavelength",
                        4e3 * way_ / ridge * texture.wavelength));
        if (!when.empty()) close_.insert(place.line);
    }

    const Plan& plan_;
    Diagnostics& diagnostics_;
    double way_;             // distance that an exploring hand travels per step [m]
    std::set<int> limited_;  // source lines of perturbations already named in a warning
    std::set<int> close_;
};

}  // namespace

void check_textures(const Plan& plan, Diagnostics& diagnostics) {
    TextureChecks(plan, diagnostics).check();
}

}  // namespace dihaptic::session
