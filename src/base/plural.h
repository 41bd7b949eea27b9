// Writes counts in messages: "1 tick", "2 ticks".
#pragma once

#include <cstdint>
#include <string>

#include "base/number.h"

namespace dihaptic {

inline std::string counted(int64_t n, const std::string& noun) {
    return number_text(n) + " " + noun + (n == 1 ? "" : "s");
}

}  // namespace dihaptic
