// The time that one call takes.
#pragma once

#include <chrono>

namespace dihaptic::bench {

/// Makes the call once, and returns how long it took [s].
template <class Call>
double duration_of(const Call& call) {
    const auto begin = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace dihaptic::bench
