// The surface on which a field is zero, as triangles.
#pragma once

#include <functional>

#include "view/triangles.h"

namespace dihaptic::view {

/// Negative inside and positive outside, [m].
using Field = std::function<double(const Vec3&)>;

/// Returns the surface between `low` and `high`, outside of which the field must be positive. Each
/// cube of side `cell` [m] through which the surface passes has one vertex (surface nets: Gibson,
/// "Constrained elastic surface nets", 1998), which is then moved onto the surface.
Triangles isosurface(const Field& field, const Vec3& low, const Vec3& high, double cell);

}  // namespace dihaptic::view
