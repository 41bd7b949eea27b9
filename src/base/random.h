// Seeded random numbers. Every consumer draws from a stream of its own, named after its purpose, so
// that adding a consumer leaves the numbers of all others unchanged.
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace dihaptic {

class Random {
  public:
    Random(uint64_t seed, std::string_view stream);

    /// Uniform in [low, high).
    double uniform(double low, double high);
    /// Normal with mean 0 and standard deviation 1.
    double normal();

  private:
    std::mt19937_64 engine_;
};

}  // namespace dihaptic
