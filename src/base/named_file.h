// A file that another file names: where it cannot be read, what has to be mended is the name, and
// the message is about the place at which it stands.
#pragma once

#include <string>

#include "base/diagnostics.h"

namespace dihaptic {

/// Throws Error when there is no file `file` that can be opened; `place` and `key` are those of its
/// name.
void check_named(const std::string& file, const Place& place, const std::string& key);

}  // namespace dihaptic
