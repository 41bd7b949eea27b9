// Describes a shape with a mass in the body's principal axes, as simulators require.
#pragma once

#include "scene/shape.h"

namespace dihaptic::scene {

/// Mass, centre of mass and principal inertia of a solid.
struct Solid {
    double mass = 0;
    Vec3 inertia = Vec3::Zero();  ///< principal moments [kg*m^2]
    Pose X_BM;                    ///< centre of mass and principal axes in B
};

/// The solid of a shape with uniform density; inertia and pose keep their defaults if there is no
/// mass or volume.
Solid solid_of(const Shape& shape, double mass);

}  // namespace dihaptic::scene
