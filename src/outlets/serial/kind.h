// The outlet `serial`: a serial line that carries 8-bit codes, as used by amplifiers and trigger
// boxes. Every incoming byte is a trigger.
#pragma once

#include "outlets/outlet.h"

namespace dihaptic::outlets::serial {

Kind kind();

}  // namespace dihaptic::outlets::serial
