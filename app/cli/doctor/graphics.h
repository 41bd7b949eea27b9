// What draws here, where a window can open, and whether a headset's runtime is there.
#pragma once

#include <functional>

#include "cli/doctor/finding.h"
#include "cli/doctor/ports.h"

namespace dihaptic::doctor {

/// The value of an environment variable; "" if it is not set.
using Variable = std::function<std::string(const char* name)>;

/// Draws a picture without a window.
Finding drawing(const std::string& root, const MayOpen& may_open);
/// `renderer`, `version`: OpenGL's names of what draws.
Finding drawn_by(const std::string& renderer, const std::string& version, const std::string& root,
                 const MayOpen& may_open);
Finding screen(const Variable& variable);
/// The runtime is not started: some start whole programs of their own.
Finding headset(const std::string& root, const Variable& variable);

}  // namespace dihaptic::doctor
