// Perturbations as an experiment file describes them, and the commands that each gives in a tick.
//
// A perturbation acts with a share from 0 to 1, so that it can begin abruptly, by a ramp over
// trials, or by a profile within one: angles, forces, and the difference of scales from 1 are
// proportional to the share.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "base/formula.h"
#include "scene/scene.h"
#include "servo/frame.h"
#include "task/loads.h"
#include "task/profile.h"

namespace dihaptic::task {

/// A named sphere where hands are wanted, and which can be shown.
struct Region {
    std::string name;
    FormulaVec3 position;   ///< centre [m]
    Formula radius = 0.01;  ///< [m]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("position", position, Field::length().within(-100, 100).required());
        v("radius", radius, Field::length().within(1e-4, 10));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A change of displayed motion: it is scaled and rotated about a region's centre, or led along the
/// straight line to another region.
struct VisualSpec {
    std::vector<std::string> moves;  ///< proxies, object, target
    std::string about;               ///< region
    FormulaVec3 scale{1, 1, 1};      ///< along the world's axes
    std::optional<Vec3> axis;        ///< axis of the rotation
    Formula angle = 0;               ///< angle of the rotation, right-handed [rad]
    std::string toward;              ///< region: motion is shown on the line from `about` to it, at
                                     ///< its true distance from `about`
    Formula size = 1;                ///< the object's displayed size over its true size
    double delay = 0;                ///< proxies and object are shown this much later [s]
    Vec3 noise = Vec3::Zero();       ///< SD of noise on where they are shown, in W [m]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("moves", moves, Field::text().required());
        v("about", about);
        v("scale", scale, Field::number().within(-10, 10));
        v("axis", axis, Field::number().within(-1000, 1000));
        v("angle", angle, Field::of(Quantity::angle).within(-6.3, 6.3));
        v("toward", toward);
        v("size", size, Field::number().within(0.1, 10));
        v("delay", delay, Field::of(Quantity::time).within(0, 5));
        v("noise", noise, Field::length().within(0, 1));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Factors on a body's properties in the scene.
struct BodySpec {
    std::string body;
    FormulaVec3 mass_scale{1, 1, 1};  ///< on inertia along the world's axes; the weight stays
    Formula weight_scale = 1;         ///< the inertia stays
    Formula density_scale = 1;        ///< on both, and on the moments of inertia
    Formula friction_scale = 1;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body, Field::text().required());
        v("mass_scale", mass_scale, Field::number().within(0.05, 20));
        v("weight_scale", weight_scale, Field::number().within(-20, 20));
        v("density_scale", density_scale, Field::number().within(0.05, 20));
        v("friction_scale", friction_scale, Field::number().within(0, 20));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Any combination of a visual map, a body's properties and loads, under one name.
struct PerturbationSpec {
    std::string name;
    Texts during;  ///< states in which it acts; empty: all that are perturbed
    std::optional<Profile> profile;
    std::optional<VisualSpec> visual;
    std::optional<BodySpec> body;
    std::optional<LoadSpec> field;  ///< the only load, or the first
    std::vector<LoadSpec> loads;
    Place place;

    /// `field` and `loads` together.
    std::vector<LoadSpec> all_loads() const {
        std::vector<LoadSpec> out = loads;
        if (field) out.insert(out.begin(), *field);
        return out;
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("during", during);
        v("profile", profile);
        v("visual", visual);
        v("body", body);
        v("field", field);
        v("loads", loads);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Whether it holds a handle or a body to a line or plane.
inline bool is_channel(const PerturbationSpec& spec) {
    const std::vector<LoadSpec> loads = spec.all_loads();
    return std::any_of(loads.begin(), loads.end(),
                       [](const LoadSpec& load) { return load.kind == LoadKind::channel; });
}

/// A perturbation with its names looked up. In the tick it neither allocates nor throws.
class Perturbation {
  public:
    Perturbation() = default;
    /// Problems with the spec go to `diagnostics`.
    Perturbation(const PerturbationSpec& spec, const std::vector<Region>& regions,
                 const scene::Scene& scene, Diagnostics& diagnostics);

    /// Factor on its share at `t` since its first state was entered [s].
    double share_at(double t) const noexcept { return profile_ ? profile_->share(t) : 1; }
    /// Adds the perturbation's commands to `out`. `regions_W`: centres of the regions [m].
    void order(double share, std::span<const Vec3> regions_W, const Motions& motions,
               servo::TaskFrame& out) const noexcept;
    /// Force of its loads over velocity, at share 1 [N*s/m]; of channels and springs zero.
    Mat3 field_gain() const;
    /// Axis of its rotation, or of its first curl field; nullopt if it has neither.
    std::optional<Vec3> axis() const;
    /// Takes up the numbers that are formulas. `resolved`: what these give, by index.
    void resolve(std::span<const double> resolved) noexcept;
    bool has_map() const { return map_.has_value(); }
    std::span<const Load> loads() const { return loads_; }
    /// Delay of what it moves on the screen, at share 1 [s].
    double delay() const { return map_ ? map_->delay : 0; }
    /// A body's properties at share 1; unset if it changes no body.
    const std::optional<servo::PropertiesFrame>& properties() const { return properties_; }

  private:
    struct Map {
        uint32_t moves = 0;
        int object = -1;
        int about = -1;
        int toward = -1;
        std::array<Number, 3> scale_as_given;
        Number angle_as_given;
        Number size_as_given;
        Vec3 scale = Vec3::Ones();
        Vec3 axis = Vec3::UnitZ();
        double angle = 0;
        double size = 1;
        double delay = 0;
        Vec3 noise = Vec3::Zero();
    };
    struct Properties {
        std::array<Number, 3> mass;
        Number weight;
        Number density;
        Number friction;
    };
    void look_up_map(const VisualSpec& visual, const std::vector<Region>& regions,
                     const scene::Scene& scene, Diagnostics& diagnostics);
    void look_up_body(const BodySpec& body, const scene::Scene& scene, Diagnostics& diagnostics);

    std::optional<Map> map_;
    Properties properties_as_given_;
    std::optional<servo::PropertiesFrame> properties_;
    std::vector<Load> loads_;
    std::optional<Profile> profile_;
};

}  // namespace dihaptic::task
