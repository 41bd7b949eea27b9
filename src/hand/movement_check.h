// Checks the units and the markers of a recorded movement by its values. Faults that can be bridged
// are handled frame by frame in repair.h.
#pragma once

#include "hand/movement.h"

namespace dihaptic::hand {

/// Largest number of errors reported for one file; more would not help its author.
constexpr size_t kMostErrors = 20;

constexpr const char* kLineRemedy = "Correct it, or delete the line: missing frames are bridged.";

/// Checks that times ascend, at a tracker's rate. A wrong unit is reported once, before its
/// consequences.
void check_times(const Movement& movement, Diagnostics& problems);

/// Checks that the movement is plausible: a reaching and grasping hand moves by centimetres to
/// decimetres, and its fingers are apart.
void check_plausible(const Movement& movement, Diagnostics& problems);

}  // namespace dihaptic::hand
