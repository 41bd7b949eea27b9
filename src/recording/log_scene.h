// Whether a log and a scene are of one session: then frames have what the scene has, one to one.
#pragma once

#include "recording/raw_log.h"
#include "scene/scene.h"

namespace dihaptic::recording {

bool fits(const LogHead& head, const scene::Scene& scene);
/// Throws Error when it does not; `file` is the log's.
void check_fits(const LogHead& head, const scene::Scene& scene, const std::string& file);

}  // namespace dihaptic::recording
