// Factors on a body's properties in the scene:
//
//     m_i (1 + s (scale_i - 1))      its inertia along each axis, and similarly its weight,
//                                    moments of inertia, friction and surface
//
// where s is the share. If several perturbations act on one body, their factors multiply.
#pragma once

#include "frame/task_frame.h"
#include "scene/scene.h"
#include "task/effects/factor.h"
#include "task/effects/load/motions.h"
#include "task/file/ref.h"

namespace dihaptic::task {

class Names;
class BodyEffect;

struct BodySpec {
    using Effect = BodyEffect;

    Ref<scene::Body> body;
    FormulaVec3 mass_scale{
        1, 1, 1};  ///< factors on the inertia along the world axes; the weight is unchanged
    Formula weight_scale = 1;   ///< factor on the weight; the inertia is unchanged
    Formula density_scale = 1;  ///< factor on the weight, inertia and moments of inertia
    Formula friction_scale = 1;
    /// Factor on the stiffness of the body's surface and on its damping.
    Formula stiffness_scale = 1;
    Formula restitution_scale = 1;  ///< factor on the restitution of the body's surface
    Formula texture_wavelength_scale = 1;
    Formula texture_height_scale = 1;
    Formula texture_friction_scale = 1;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body, Field::text().required().says("Body whose properties are changed."));
        v("mass_scale", mass_scale,
          Field::number().within(0.05, 20).says(
              "Factors on the body's inertia along the world axes; its weight stays the same."));
        v("weight_scale", weight_scale,
          Field::number().within(-20, 20).says(
              "Factor on the body's weight; its inertia stays the same."));
        v("density_scale", density_scale,
          Field::number().within(0.05, 20).says(
              "Factor on the body's weight, inertia and moments of inertia together."));
        v("friction_scale", friction_scale,
          Field::number().within(0, 20).says("Factor on the body's coefficients of friction."));
        v("stiffness_scale", stiffness_scale,
          Field::number().within(0.01, 100).says(
              "Factor on the stiffness and damping of the body's surface."));
        v("restitution_scale", restitution_scale,
          Field::number().within(0, 100).says(
              "Factor on the restitution of the body's surface, which is limited to 1."));
        v("texture_wavelength_scale", texture_wavelength_scale,
          Field::number().within(0.01, 100).says(
              "Factor on the wavelength of the body's texture."));
        v("texture_height_scale", texture_height_scale,
          Field::number().within(0, 100).says("Factor on the height of the body's texture."));
        v("texture_friction_scale", texture_friction_scale,
          Field::number().within(0, 100).says("Factor on the variation of friction along the "
                                              "body's texture, which is limited to 1."));
    }
};

/// Appends descriptions of the changes and their sizes to `out`, for a report.
void say(const BodySpec& spec, std::vector<std::string>& out);

class BodyEffect {
  public:
    /// Problems in the spec are added to `diagnostics`.
    BodyEffect(const BodySpec& spec, const Names& names, const scene::Scene& scene,
               Diagnostics& diagnostics);

    /// The body's properties when the effect's share is 1.
    frame::PropertiesFrame properties() const noexcept;
    void order(double share, std::span<const Vec3> regions_W, const Motions& motions,
               frame::TaskFrame& out) const noexcept;
    template <class Visitor>
    void visit(Visitor& v) {
        spec_.visit(v);
    }

  private:
    BodySpec spec_;
};

}  // namespace dihaptic::task
