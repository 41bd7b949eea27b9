// Checks the renderer, the screen on which windows appear, and a headset's runtime.
#pragma once

#include <functional>

#include "cli/doctor/finding.h"
#include "cli/doctor/ports.h"

namespace dihaptic::doctor {

/// The value of an environment variable; "" if it is not set.
using Variable = std::function<std::string(const char* name)>;

/// Checks whether a picture can be drawn without a window.
Finding drawing(const std::string& root, const MayOpen& may_open);
/// Judges the renderer. `renderer`, `version`: their names as given by OpenGL.
Finding drawn_by(const std::string& renderer, const std::string& version, const std::string& root,
                 const MayOpen& may_open);
Finding screen(const Variable& variable);
/// Checks for a headset's runtime. Does not start the runtime, because some runtimes start entire
/// programs.
Finding headset(const std::string& root, const Variable& variable);

}  // namespace dihaptic::doctor
