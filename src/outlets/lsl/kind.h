// The outlet `lsl`: streams of the Lab Streaming Layer with event codes, and with handle positions
// and forces.
#pragma once

#include "outlets/outlet.h"

namespace dihaptic::outlets::lsl {

Kind kind();

}  // namespace dihaptic::outlets::lsl
