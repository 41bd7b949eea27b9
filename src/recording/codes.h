// Explains the numeric codes in frames: phases, outcomes, messages, status bits, solvers,
// couplings.
#pragma once

#include <string>

#include "recording/raw_log.h"

namespace dihaptic::recording {

/// Meanings of a field's codes, e.g. "0: between trials, 1: home, 2: reach"; "" if the field is an
/// ordinary number. `name` is the name of the Frame field, without the prefix of a finger or body.
std::string codes_of(const std::string& name, const LogHead& head);

}  // namespace dihaptic::recording
