// Contact problems of other simulators, in the FCLIB layout (HDF5).
#pragma once

#include <string>

#include "contact/problem.h"

namespace dihaptic::measure {

/// Reads `fclib_local`: W, q and mu, three rows a contact.
/// Throws Error when the file cannot be read, has not that layout, or W does not fit q and mu.
contact::DelassusProblem read_contact_file(const std::string& file);

}  // namespace dihaptic::measure
