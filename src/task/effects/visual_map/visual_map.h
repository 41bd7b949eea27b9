// A visual map: the difference between displayed and true motion. At share s, a point p is shown at
//
//     c + R(s angle, axis) (1 + s (scale - 1)) (p - c)      c is a region's centre; or, on a line,
//     c + |p - c| e                                         e points from c toward another region
//
// and then displaced by s times the shift.
#pragma once

#include <optional>
#include <span>

#include "frame/task_frame.h"
#include "scene/scene.h"
#include "task/effects/factor.h"
#include "task/effects/load/motions.h"
#include "task/file/ref.h"
#include "task/file/region.h"

namespace dihaptic::task {

class Names;
class VisualEffect;

/// A transformation of displayed motion: scaling and rotation about a region's centre, or
/// projection onto the straight line to another region.
struct VisualSpec {
    using Effect = VisualEffect;

    /// Displayed objects that move: any of proxies, object and target.
    std::vector<std::string> moves;
    Ref<Region> about;
    FormulaVec3 scale{1, 1, 1};  ///< factors on displayed motion along the world axes
    std::optional<Vec3> axis;    ///< axis of the rotation
    Formula angle = 0;           ///< angle of the rotation, right-handed [rad]
    Ref<Region> toward;   ///< region at the end of the line on which motion is shown, at its true
                          ///< distance from `about`
    Formula size = 1;     ///< ratio of the object's displayed size to its true size
    Formula delay = 0;    ///< display delay of the proxies and the object [s]
    FormulaVec3 shift{};  ///< displacement of the displayed objects in the world frame W [m]
    FormulaVec3 noise{};  ///< standard deviation of the noise on displayed positions along the
                          ///< axes of W [m]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("moves", moves,
          Field::text().required().says(
              "Displayed objects that the map moves: any of proxies, object and target."));
        v("about", about,
          says("Region about whose centre motion is scaled and rotated, or at which the line "
               "starts."));
        v("scale", scale,
          Field::number().within(-10, 10).says(
              "Factors on displayed motion along the world axes."));
        v("axis", axis,
          Field::number().within(-1000, 1000).says("Axis of the rotation, through the centre."));
        v("angle", angle,
          Field::of(Quantity::angle)
              .within(-6.3, 6.3)
              .says("Angle of the rotation, right-handed."));
        v("toward", toward,
          says("Region at the end of the line on which motion is shown, at its true distance from "
               "the start."));
        v("size", size,
          Field::number().within(0.1, 10).says(
              "Ratio of the object's displayed size to its true size."));
        v("delay", delay,
          Field::of(Quantity::time)
              .within(0, 5)
              .says("Delay with which proxies and object are shown."));
        v("shift", shift,
          Field::length().within(-10, 10).says(
              "Displacement of what is shown, along the world axes, after scaling and rotation."));
        v("noise", noise,
          Field::length().within(0, 1).says(
              "Standard deviation of noise on the displayed positions, along the world axes."));
    }
};

/// Appends descriptions of the changes and their sizes to `out`, for a report.
void say(const VisualSpec& spec, std::vector<std::string>& out);

class VisualEffect {
  public:
    /// Problems in the spec are added to `diagnostics`.
    VisualEffect(const VisualSpec& spec, const Names& names, const scene::Scene& scene,
                 Diagnostics& diagnostics);

    /// The axis of the map's rotation; unset if there is no rotation.
    std::optional<Vec3> axis() const;
    /// Upper bound on the map's delay [s].
    double longest_delay() const;
    void order(double share, std::span<const Vec3> regions_W, const Motions& motions,
               frame::TaskFrame& out) const noexcept;
    template <class Visitor>
    void visit(Visitor& v) {
        spec_.visit(v);
    }

  private:
    void check(Diagnostics& diagnostics) const;

    VisualSpec spec_;
    uint32_t moves_ = 0;  // bitwise OR of frame::Moves values
    int object_ = -1;
    Vec3 axis_ = Vec3::UnitZ();
};

}  // namespace dihaptic::task
