// Reads a scene from text, for use in tests.
#pragma once

#include <string>

#include "base/node.h"
#include "scene/scene.h"

namespace dihaptic::scene {

inline Scene read_text(const std::string& yaml, Diagnostics& diagnostics) {
    Scene scene;
    read_fields(scene, parse_yaml(yaml, "scene.yaml"), diagnostics);
    complete(scene, "", diagnostics);
    return scene;
}

}  // namespace dihaptic::scene
