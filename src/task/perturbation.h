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
#include "frame/frame.h"
#include "scene/scene.h"
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
        v("name", name, Field::text().required().says("Name of the region."));
        v("position", position, Field::length().within(-100, 100).required().says("Its centre."));
        v("radius", radius, Field::length().within(1e-4, 10).says("Its radius."));
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
    Formula delay = 0;               ///< proxies and object are shown this much later [s]
    Vec3 noise = Vec3::Zero();       ///< SD of noise on where they are shown, in W [m]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("moves", moves,
          Field::text().required().says(
              "What is shown elsewhere than it is: any of proxies, object and target."));
        v("about", about,
          says("Region about whose centre motion is scaled and rotated, or from "
               "which the line begins."));
        v("scale", scale,
          Field::number().within(-10, 10).says(
              "Factors on displayed motion along the world's axes."));
        v("axis", axis,
          Field::number().within(-1000, 1000).says("Axis of the rotation, through the centre."));
        v("angle", angle,
          Field::of(Quantity::angle)
              .within(-6.3, 6.3)
              .says("Angle of the rotation, right-handed."));
        v("toward", toward,
          says("Region that the line leads to on which motion is shown, at its true "
               "distance from the beginning."));
        v("size", size,
          Field::number().within(0.1, 10).says("Displayed over true size of the object."));
        v("delay", delay,
          Field::of(Quantity::time)
              .within(0, 5)
              .says("How much later proxies and object are shown."));
        v("noise", noise,
          Field::length().within(0, 1).says(
              "Standard deviation of noise on where they are shown, along the world's axes."));
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
    Formula stiffness_scale = 1;    ///< of its surface, with its damping
    Formula restitution_scale = 1;  ///< of its surface
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body, Field::text().required().says("Body whose properties are changed."));
        v("mass_scale", mass_scale,
          Field::number().within(0.05, 20).says(
              "Factors on its inertia along the world's axes; its weight stays."));
        v("weight_scale", weight_scale,
          Field::number().within(-20, 20).says("Factor on its weight; its inertia stays."));
        v("density_scale", density_scale,
          Field::number().within(0.05, 20).says(
              "Factor on weight, inertia and moments of inertia together."));
        v("friction_scale", friction_scale,
          Field::number().within(0, 20).says("Factor on its coefficients of friction."));
        v("stiffness_scale", stiffness_scale,
          Field::number().within(0.01, 100).says(
              "Factor on the stiffness and damping of its surface."));
        v("restitution_scale", restitution_scale,
          Field::number().within(0, 100).says(
              "Factor on the restitution of its surface, which stays at most 1."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Factors on a joint's properties in the scene.
struct JointSpec {
    std::string joint;
    Formula stiffness_scale = 1;  ///< of its spring
    Formula damping_scale = 1;    ///< of its damper
    Formula friction_scale = 1;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field factor = Field::number().within(0, 100);
        v("joint", joint, Field::text().required().says("Joint whose properties are changed."));
        v("stiffness_scale", stiffness_scale,
          factor.says("Factor on the stiffness of its spring."));
        v("damping_scale", damping_scale, factor.says("Factor on the damping of its damper."));
        v("friction_scale", friction_scale, factor.says("Factor on its dry friction."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Any combination of a visual map, properties of a body and a joint, and loads, under one name.
struct PerturbationSpec {
    std::string name;
    Texts during;  ///< states in which it acts; empty: all that are perturbed
    std::optional<Profile> profile;
    std::optional<VisualSpec> visual;
    std::optional<BodySpec> body;
    std::optional<JointSpec> joint;
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
        v("name", name, Field::text().required().says("Name of the perturbation."));
        v("during", during,
          says("States in which it acts; left out, all but those with perturbed: no."));
        v("profile", profile,
          says("Its course in time within a trial; left out, it acts at once and stays."));
        v("visual", visual, says("Difference between what is shown and what is."));
        v("body", body, says("Change of a body's properties."));
        v("joint", joint, says("Change of a joint's properties."));
        v("field", field, says("A load, as in loads; it is the only one, or the first."));
        v("loads", loads, says("Forces and torques on the handles of fingers and on bodies."));
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
               frame::TaskFrame& out) const noexcept;
    /// Force of its loads over velocity, at share 1 [N*s/m]; of channels and springs zero.
    Mat3 field_gain() const;
    /// Axis of its rotation, or of its first curl field; nullopt if it has neither.
    std::optional<Vec3> axis() const;
    /// Takes up the numbers that are formulas. `resolved`: what these give, by index.
    void resolve(std::span<const double> resolved) noexcept;
    bool has_map() const { return map_.has_value(); }
    std::span<const Load> loads() const { return loads_; }
    /// The most that the delay of what it moves on the screen may be [s].
    double longest_delay() const { return map_ ? map_->longest_delay : 0; }
    /// A body's properties at share 1; unset if it changes no body.
    const std::optional<frame::PropertiesFrame>& properties() const { return properties_; }

  private:
    struct Map {
        uint32_t moves = 0;
        int object = -1;
        int about = -1;
        int toward = -1;
        std::array<Number, 3> scale_as_given;
        Number angle_as_given;
        Number size_as_given;
        Number delay_as_given;
        Vec3 scale = Vec3::Ones();
        Vec3 axis = Vec3::UnitZ();
        double angle = 0;
        double size = 1;
        double delay = 0;
        double longest_delay = 0;
        Vec3 noise = Vec3::Zero();
    };
    struct Properties {
        std::array<Number, 3> mass;
        Number weight;
        Number density;
        Number friction;
        Number stiffness;
        Number restitution;
    };
    void look_up_map(const VisualSpec& visual, const std::vector<Region>& regions,
                     const scene::Scene& scene, Diagnostics& diagnostics);
    void look_up_body(const BodySpec& body, const scene::Scene& scene, Diagnostics& diagnostics);
    void look_up_joint(const JointSpec& joint, const scene::Scene& scene, Diagnostics& diagnostics);

    std::optional<Map> map_;
    Properties properties_as_given_;
    std::optional<frame::PropertiesFrame> properties_;
    std::array<Number, 3> joint_as_given_{};  // factors on stiffness, damping, friction
    std::optional<frame::JointPropertiesFrame> joint_;
    std::vector<Load> loads_;
    std::optional<Profile> profile_;
};

}  // namespace dihaptic::task
