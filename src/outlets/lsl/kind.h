// Streams of the Lab Streaming Layer: event codes, and handle positions and forces.
#pragma once

#include "outlets/outlet.h"

namespace dihaptic::outlets::lsl {

Kind kind();

}  // namespace dihaptic::outlets::lsl
