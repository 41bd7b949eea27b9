// Checks the renderer, the screen for a window, and a headset's runtime.
#pragma once

#include <functional>

#include "cli/doctor/finding.h"
#include "cli/doctor/ports.h"

namespace dihaptic::doctor {

/// The value of an environment variable; "" if it is not set.
using Variable = std::function<std::string(const char* name)>;

/// Draws a picture without a window.
Finding drawing(const std::string& root, const MayOpen& may_open);
/// `renderer`, `version`: OpenGL's names for them.
Finding drawn_by(const std::string& renderer, const std::string& version, const std::string& root,
                 const MayOpen& may_open);
Finding screen(const Variable& variable);
/// Does not start the runtime, because some runtimes start entire programs.
Finding headset(const std::string& root, const Variable& variable);

}  // namespace dihaptic::doctor
