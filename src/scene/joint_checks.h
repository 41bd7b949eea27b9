// Checks a scene's joints.
#pragma once

#include "scene/scene.h"

namespace dihaptic::scene {

void check_joints(const Scene& scene, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
