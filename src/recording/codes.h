// What the numbers stand for that frames have in place of names: phases, outcomes, messages, bits
// of a status, solvers, couplings.
#pragma once

#include <string>

#include "recording/raw_log.h"

namespace dihaptic::recording {

/// "0: between trials, 1: home, 2: reach"; "" where the number stands for itself. `name`: of a
/// field of Frame, without the finger's or body's before it.
std::string codes_of(const std::string& name, const LogHead& head);

}  // namespace dihaptic::recording
