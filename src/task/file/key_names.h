// Finds keys by name, for programs and simulated people that press keys.
#pragma once

#include <optional>
#include <string_view>

#include "task/file/rating.h"

namespace dihaptic::task {

/// Returns the key with the given name, i.e. "Enter", "Backspace" or a single character, or nullopt
/// if there is no such key.
inline std::optional<char> key_named(std::string_view name) {
    if (name == "Enter") return Rating::kEnter;
    if (name == "Backspace") return Rating::kBack;
    if (name.size() != 1) return std::nullopt;
    return name.front();
}

}  // namespace dihaptic::task
