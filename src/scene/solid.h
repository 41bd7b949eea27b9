// A shape with a mass, as simulators take it that know bodies by their principal axes.
#pragma once

#include "scene/shape.h"

namespace dihaptic::scene {

/// Mass, centre of mass and principal inertia of a solid.
struct Solid {
    double mass = 0;
    Vec3 inertia = Vec3::Zero();  ///< principal moments [kg*m^2]
    Pose X_BM;                    ///< centre of mass and principal axes in B
};

/// Of even density; all zero without mass or volume.
Solid solid_of(const Shape& shape, double mass);

}  // namespace dihaptic::scene
