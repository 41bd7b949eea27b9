// Describes a shape with a mass in the principal axes of the body, as simulators require.
#pragma once

#include "scene/shape.h"

namespace dihaptic::scene {

/// Mass, centre of mass and principal inertia of a solid.
struct Solid {
    double mass = 0;
    Vec3 inertia = Vec3::Zero();  ///< principal moments of inertia [kg*m^2]
    Pose X_BM;                    ///< centre of mass and principal axes in B
};

/// The solid with this shape and uniform density. Inertia and pose keep their defaults if there is
/// no mass or no volume.
Solid solid_of(const Shape& shape, double mass);

}  // namespace dihaptic::scene
