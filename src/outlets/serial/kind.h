// A serial line with 8-bit codes, as amplifiers and trigger boxes take them; what comes in on it is
// a trigger.
#pragma once

#include "outlets/outlet.h"

namespace dihaptic::outlets::serial {

Kind kind();

}  // namespace dihaptic::outlets::serial
