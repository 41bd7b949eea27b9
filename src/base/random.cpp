#include "base/random.h"

#include <cmath>
#include <numbers>

namespace dihaptic {
namespace {

/// FNV-1a hash of the stream's name, starting from the seed.
uint64_t mix(uint64_t seed, std::string_view stream) {
    uint64_t hash = 14695981039346656037ULL ^ (seed * 0x9E3779B97F4A7C15ULL);
    for (const char c : stream) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 1099511628211ULL;
    }
    return hash;
}

}  // namespace

Random::Random(uint64_t seed, std::string_view stream) : engine_(mix(seed, stream)) {}

// The results of the standard library's distributions may differ between implementations, so this
// function does not use them.
double Random::uniform(double low, double high) {
    const double unit = static_cast<double>(engine_() >> 11) * 0x1.0p-53;
    return low + (high - low) * unit;
}

double Random::normal() {
    // Box-Muller transform; 1 - u is never 0, which keeps the logarithm finite
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0, 1)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(0, 1));
}

}  // namespace dihaptic
