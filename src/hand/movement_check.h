// What the values of a recorded movement tell about its units and its markers. What is judged line
// by line, and bridged, is repair.h's business.
#pragma once

#include "hand/movement.h"

namespace dihaptic::hand {

/// Of one file: more are no help.
constexpr size_t kMostErrors = 20;

constexpr const char* kLineRemedy = "Correct it, or delete the line: missing frames are bridged.";

/// Times must rise, at a tracker's rate. A wrong unit is told once, before its consequences.
void check_times(const Movement& movement, Diagnostics& problems);

/// A hand that reaches and grasps moves by centimetres to decimetres, and its fingers apart.
void check_plausible(const Movement& movement, Diagnostics& problems);

}  // namespace dihaptic::hand
