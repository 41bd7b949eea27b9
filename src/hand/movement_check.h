// Uses the values of a recorded movement to check its units and markers. Faults that can be bridged
// are handled frame by frame in repair.h.
#pragma once

#include "hand/movement.h"

namespace dihaptic::hand {

/// Maximum number of errors reported for one file; more would not help the file's author.
constexpr size_t kMostErrors = 20;

constexpr const char* kLineRemedy = "Correct it, or delete the line: missing frames are bridged.";

/// Checks that times increase, at the rate of a tracker. A wrong unit is reported once, before the
/// errors that follow from it.
void check_times(const Movement& movement, Diagnostics& problems);

/// Checks that the movement is plausible: a hand that reaches and grasps moves by centimetres to
/// decimetres, and its fingers do not coincide.
void check_plausible(const Movement& movement, Diagnostics& problems);

}  // namespace dihaptic::hand
