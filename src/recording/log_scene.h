// Checks whether a log and a scene belong to the same session: the fingers and bodies of the log
// must be exactly those of the scene.
#pragma once

#include "recording/raw_log.h"
#include "scene/scene.h"

namespace dihaptic::recording {

bool fits(const LogHead& head, const scene::Scene& scene);
/// Throws Error when the log does not match the scene; `file` is the name of the log.
void check_fits(const LogHead& head, const scene::Scene& scene, const std::string& file);

}  // namespace dihaptic::recording
