// The outlet `serial`: a serial line with 8-bit codes, as amplifiers and trigger boxes take them. A
// byte that comes in is a trigger.
#pragma once

#include "outlets/outlet.h"

namespace dihaptic::outlets::serial {

Kind kind();

}  // namespace dihaptic::outlets::serial
