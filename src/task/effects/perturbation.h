// Perturbations as described in an experiment file, and the commands that each of them gives in a
// tick.
//
// A perturbation acts with a share from 0 to 1, so that it can start abruptly, ramp up over trials,
// or follow a profile within a trial: angles, forces, and the differences of scales from 1 are
// proportional to the share. A perturbation consists of effects. Each kind of effect has a folder
// in `effects`, which contains its keys in the file, its checks, its commands, and its description
// in a report.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "task/effects/body/body.h"
#include "task/effects/joint/joint.h"
#include "task/effects/load/load.h"
#include "task/effects/visual_map/visual_map.h"
#include "task/file/profile.h"

namespace dihaptic::task {

struct State;

/// Any combination of a visual map, properties of a body and a joint, and loads, under one name.
struct PerturbationSpec {
    std::string name;
    Refs<State> during;  ///< states in which the perturbation acts; if empty, all states that are
                         ///< `perturbed`
    std::optional<Profile> profile;
    std::optional<VisualSpec> visual;
    std::optional<BodySpec> body;
    std::optional<JointSpec> joint;
    std::optional<LoadSpec> field;  ///< the only load or, if there are several, the first
    std::vector<LoadSpec> loads;
    std::string hed;  ///< HED tags for the event that begins the perturbation
    Place place;

    /// Calls f(effect) for each of the perturbation's effects.
    template <class F>
    void each_effect(F f) const {
        if (visual) f(*visual);
        if (body) f(*body);
        if (joint) f(*joint);
        for (const LoadSpec& load : all_loads()) f(load);
    }
    /// Returns `field` and `loads` in one list.
    std::vector<LoadSpec> all_loads() const {
        std::vector<LoadSpec> out = loads;
        if (field) out.insert(out.begin(), *field);
        return out;
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the perturbation."));
        v("during", during,
          says("States in which the perturbation acts; if omitted, all except those with "
               "'perturbed: no'."));
        v("profile", profile,
          says("Time course within a trial; if omitted, the perturbation acts at once and "
               "throughout."));
        v("visual", visual, says("Difference between displayed and true motion."));
        v("body", body, says("Change in a body's properties."));
        v("joint", joint, says("Change in a joint's properties."));
        v("field", field,
          says("A single load, or the first one, with the same keys as in 'loads'."));
        v("loads", loads, says("Forces and torques on the handles of fingers and on bodies."));
        v("hed", hed, says("HED tags of the perturbation's beginning, for the export to BIDS."));
    }
};

/// Whether the perturbation confines a handle or a body to a line or plane.
inline bool is_channel(const PerturbationSpec& spec) {
    const std::vector<LoadSpec> loads = spec.all_loads();
    return std::any_of(loads.begin(), loads.end(),
                       [](const LoadSpec& load) { return load.kind == LoadKind::channel; });
}

/// A perturbation whose names have been looked up. It does not allocate or throw during a tick.
class Perturbation {
  public:
    Perturbation() = default;
    /// Problems in the spec are added to `diagnostics`.
    Perturbation(const PerturbationSpec& spec, const Names& names, const scene::Scene& scene,
                 Diagnostics& diagnostics);

    /// Factor on the perturbation's share at time `t` after entry into the first state in which it
    /// acts [s].
    double share_at(double t) const noexcept { return profile_ ? profile_->share(t) : 1; }
    /// Adds the perturbation's commands to `out`. `regions_W` are the centres of the regions [m].
    void order(double share, std::span<const Vec3> regions_W, const Motions& motions,
               frame::TaskFrame& out) const noexcept;
    /// Matrix that maps velocity to the force of the perturbation's loads at share 1 [N*s/m]; zero
    /// for channels and springs.
    Mat3 field_gain() const;
    /// Delay of the first load that depends on velocity [s]; 0 if there is none.
    double field_delay() const;
    /// Axis of the perturbation's visual rotation or of its first curl field; nullopt if it has
    /// neither.
    std::optional<Vec3> axis() const;
    bool has_map() const { return !of<VisualEffect>().empty(); }
    std::span<const Load> loads() const { return of<Load>(); }
    /// Upper bound on the perturbation's visual delay [s].
    double longest_delay() const { return has_map() ? of<VisualEffect>()[0].longest_delay() : 0; }
    /// The body's properties at share 1; unset if the perturbation changes no body.
    std::optional<frame::PropertiesFrame> properties() const;

    /// Visits the formulas of the perturbation's profile and effects.
    template <class Visitor>
    void visit(Visitor& v) {
        if (profile_) profile_->visit(v);
        each_effect(*this, [&](auto& effect) { effect.visit(v); });
    }

  private:
    template <class Self, class F>
    static void each_effect(Self& self, F f) {
        const auto each = [&](auto& list) {
            for (auto& effect : list) f(effect);
        };
        std::apply([&](auto&... lists) { (each(lists), ...); }, self.effects_);
    }
    template <class Effect>
    const std::vector<Effect>& of() const {
        return std::get<std::vector<Effect>>(effects_);
    }

    std::tuple<std::vector<VisualEffect>, std::vector<BodyEffect>, std::vector<JointEffect>,
               std::vector<Load>>
        effects_;
    std::optional<Profile> profile_;
};

}  // namespace dihaptic::task
