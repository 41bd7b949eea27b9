// Checks whether a log and a scene belong to one session: the log must have the scene's fingers and
// bodies, one to one.
#pragma once

#include "recording/raw_log.h"
#include "scene/scene.h"

namespace dihaptic::recording {

bool fits(const LogHead& head, const scene::Scene& scene);
/// Throws Error when the log does not fit the scene; `file` is the log's.
void check_fits(const LogHead& head, const scene::Scene& scene, const std::string& file);

}  // namespace dihaptic::recording
