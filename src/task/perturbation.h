// Perturbations as an experiment file describes them, and the commands that each gives in a tick.
//
// A perturbation acts with a share from 0 to 1, so that it can begin abruptly or by a ramp: angles,
// forces, and the difference of scales from 1 are proportional to the share.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "haptics/coupling.h"
#include "scene/scene.h"
#include "servo/frame.h"

namespace dihaptic::task {

/// A named sphere where hands are wanted, and which can be shown.
struct Region {
    std::string name;
    Vec3 position = Vec3::Zero();  ///< centre [m]
    double radius = 0.01;          ///< [m]
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
    Vec3 scale = Vec3::Ones();       ///< along the world's axes
    std::optional<Vec3> axis;        ///< axis of the rotation
    double angle = 0;                ///< angle of the rotation, right-handed [rad]
    std::string toward;              ///< region: motion is shown on the line from `about` to it, at
                                     ///< its true distance from `about`
    double size = 1;                 ///< the object's displayed size over its true size
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("moves", moves, Field::text().required());
        v("about", about, Field::text().required());
        v("scale", scale, Field::number().within(-10, 10));
        v("axis", axis, Field::number().within(-1000, 1000));
        v("angle", angle, Field::of(Quantity::angle).within(-6.3, 6.3));
        v("toward", toward);
        v("size", size, Field::number().within(0.1, 10));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Factors on a body's properties in the scene.
struct BodySpec {
    std::string body;
    Vec3 mass_scale = Vec3::Ones();  ///< on inertia along the world's axes; the weight stays
    double weight_scale = 1;         ///< the inertia stays
    double density_scale = 1;        ///< on both, and on the moments of inertia
    double friction_scale = 1;
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

/// Force of the field: viscous -b v; curl b e x v; channel -k d - b v_across, with d the
/// displacement from the line between two regions.
enum class FieldKind { viscous, curl, channel };
constexpr auto enum_names(FieldKind) {
    return std::array{"viscous", "curl", "channel"};
}

struct ForceFieldSpec {
    FieldKind kind = FieldKind::viscous;
    std::string on;            ///< a finger's handle, or a body
    double damping = 0;        ///< b [N*s/m]
    double stiffness = 0;      ///< k, channel only [N/m]
    std::optional<Vec3> axis;  ///< e, curl only
    std::string from;          ///< region, channel only
    std::string to;            ///< region, channel only
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, Field::text().required());
        v("on", on, Field::text().required());
        v("damping", damping, Field::of(Quantity::damping).within(-1000, 1000));
        v("stiffness", stiffness, Field::of(Quantity::stiffness).within(0, 1e5));
        v("axis", axis, Field::number().within(-1000, 1000));
        v("from", from);
        v("to", to);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Any combination of the three, under one name.
struct PerturbationSpec {
    std::string name;
    std::optional<VisualSpec> visual;
    std::optional<BodySpec> body;
    std::optional<ForceFieldSpec> field;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required());
        v("visual", visual);
        v("body", body);
        v("field", field);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A perturbation with its names looked up. In the tick it neither allocates nor throws.
class Perturbation {
  public:
    Perturbation() = default;
    /// Problems with the spec go to `diagnostics`.
    Perturbation(const PerturbationSpec& spec, const std::vector<Region>& regions,
                 const scene::Scene& scene, Diagnostics& diagnostics);

    /// Adds the perturbation's commands to `out`. `regions_W`: centres of the regions [m].
    void order(double share, std::span<const Vec3> regions_W, const servo::Frame& last,
               std::span<const haptics::Handle> handles, servo::TaskFrame& out) const noexcept;
    /// Force of its field on a point at p_W that moves with v_W [N].
    Vec3 force(double share, std::span<const Vec3> regions_W, const Vec3& p_W,
               const Vec3& v_W) const noexcept;
    /// Axis of its rotation or curl field; nullopt if it has neither.
    std::optional<Vec3> axis() const;
    /// Damping b and stiffness k of a field on a handle, to compare with what a device can render.
    struct OnHandle {
        int finger;
        double damping;    ///< [N*s/m]
        double stiffness;  ///< [N/m]
    };
    /// Nullopt if there is no field on a handle.
    std::optional<OnHandle> on_handle() const;
    /// A body's properties at share 1; unset if it changes no body.
    const std::optional<servo::PropertiesFrame>& properties() const { return properties_; }

  private:
    struct Map {
        uint32_t moves = 0;
        int object = -1;
        int about = -1;
        int toward = -1;
        Vec3 scale = Vec3::Ones();
        Vec3 axis = Vec3::UnitZ();
        double angle = 0;
        double size = 1;
    };
    struct ForceField {
        FieldKind kind = FieldKind::viscous;
        int index = -1;  // body, or body count + finger
        int finger = -1;
        double damping = 0;
        double stiffness = 0;
        Vec3 axis = Vec3::UnitZ();
        int from = -1;
        int to = -1;
    };
    void look_up_map(const VisualSpec& visual, const std::vector<Region>& regions,
                     const scene::Scene& scene, Diagnostics& diagnostics);
    void look_up_body(const BodySpec& body, const scene::Scene& scene, Diagnostics& diagnostics);
    void look_up_field(const ForceFieldSpec& given, const std::vector<Region>& regions,
                       const scene::Scene& scene, Diagnostics& diagnostics);

    std::optional<Map> map_;
    std::optional<servo::PropertiesFrame> properties_;
    std::optional<ForceField> field_;
};

}  // namespace dihaptic::task
