// Checks the names in a scene, and what refers to them.
#pragma once

#include "scene/scene.h"

namespace dihaptic::scene {

/// Checks that all names can be used, that each is used once, and that columns of recordings
/// differ.
void check_names(const Scene& scene, Diagnostics& diagnostics);
/// Checks that joints, pairs and the object name bodies that exist.
void check_references(const Scene& scene, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
