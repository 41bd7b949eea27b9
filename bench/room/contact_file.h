// Reads contact problems of other simulators from files in the FCLIB layout (HDF5).
#pragma once

#include <string>

#include "contact/problem.h"

namespace dihaptic::bench {

/// Reads `fclib_local`: W, q and mu; W and q have three rows per contact. Throws Error when the
/// file cannot be read, does not have that layout, or has a W that does not fit q and mu.
contact::DelassusProblem read_contact_file(const std::string& file);

}  // namespace dihaptic::bench
