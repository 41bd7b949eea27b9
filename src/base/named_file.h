// Checks a file whose name is given in another file. If it cannot be read, the name has to be
// corrected, so the error message refers to the place where the name is written.
#pragma once

#include <string>

#include "base/diagnostics.h"

namespace dihaptic {

/// Throws Error if `file` cannot be opened; `place` and `key` say where its name is written.
void check_named(const std::string& file, const Place& place, const std::string& key);

}  // namespace dihaptic
