// Checks a file that another file names. If the file cannot be read, it is the name that has to be
// corrected, so the message refers to the place where the name is written.
#pragma once

#include <string>

#include "base/diagnostics.h"

namespace dihaptic {

/// Throws Error when `file` cannot be opened; `place` and `key` say where its name is written.
void check_named(const std::string& file, const Place& place, const std::string& key);

}  // namespace dihaptic
