// Checks a scene's bodies: their shapes, masses, surfaces, and whether they start in each other.
#pragma once

#include "scene/scene.h"

namespace dihaptic::scene {

/// Checks the parts of a compound shape.
void check_parts(const Shape& shape, const Place& place, Diagnostics& diagnostics);
/// Warns of a shape that is larger than anything on a table.
void check_plausible(const Shape& shape, const Place& place, Diagnostics& diagnostics);
/// Checks what a body is made of and where it starts.
void check_body(const Body& body, Diagnostics& diagnostics);
/// Warns of bodies that sink deep into their support under their own weight.
void check_softness(const Scene& scene, Diagnostics& diagnostics);
void check_surfaces(const Scene& scene, Diagnostics& diagnostics);
/// Warns of bodies that start inside a fixed body, because contact forces would push or shoot them
/// out.
void check_overlaps(const Scene& scene, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
