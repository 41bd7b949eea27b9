// Describes a camera, i.e. a viewpoint from which a scene is drawn.
#pragma once

#include <numbers>
#include <string>

#include "base/field.h"
#include "base/geometry.h"

namespace dihaptic::scene {

struct Camera {
    std::string name;
    Vec3 position{0, -0.5, 0.35};  ///< position of the viewpoint, in W [m]
    Vec3 look_at = Vec3::Zero();   ///< the point at the centre of the picture, in W [m]
    double field_of_view = 30 * std::numbers::pi / 180;  ///< vertical field of view [rad]

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the camera."));
        v("position", position,
          Field::length().within(-100, 100).required().says("Position of the camera."));
        v("look_at", look_at,
          Field::length().within(-100, 100).says("Point at the centre of the picture."));
        v("field_of_view", field_of_view,
          Field::of(Quantity::angle).within(0.02, 2.5).says("Vertical angle of view."));
    }
};

}  // namespace dihaptic::scene
