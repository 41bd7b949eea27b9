// Colours that persons with any kind of colour vision tell apart: those of Okabe and Ito, "Color
// Universal Design" (2008), for what the scene file gives no colour.
#pragma once

#include <string>

#include "scene/scene.h"

namespace dihaptic::view {

/// Linear red, green, blue of the colour "#rrggbb"; grey for anything else.
Vec3 linear_colour(const std::string& hex);

Vec3 body_colour(const scene::Scene& scene, size_t body);
Vec3 finger_colour(size_t finger);

}  // namespace dihaptic::view
