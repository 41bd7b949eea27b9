// The outlet `lsl`: Lab Streaming Layer streams that carry event codes, handle positions and
// forces.
#pragma once

#include "outlets/outlet.h"

namespace dihaptic::outlets::lsl {

Kind kind();

}  // namespace dihaptic::outlets::lsl
