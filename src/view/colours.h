// Colours of bodies and fingers. If the scene file gives no colour, one from Okabe and Ito's "Color
// Universal Design" (2008) is used; people with any kind of colour vision can distinguish these
// colours.
#pragma once

#include <string>

#include "scene/scene.h"

namespace dihaptic::view {

/// Linear red, green and blue of the colour "#rrggbb"; grey for any other text.
Vec3 linear_colour(const std::string& hex);
/// The same for a number. `rgb`: 65536 red + 256 green + blue, each from 0 to 255.
Vec3 linear_colour(uint32_t rgb);

Vec3 body_colour(const scene::Scene& scene, size_t body);
Vec3 finger_colour(size_t finger);

}  // namespace dihaptic::view
