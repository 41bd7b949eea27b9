// Seeded random numbers. Each consumer draws from its own stream, named after its purpose, so that
// adding a consumer does not change the numbers of the others.
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace dihaptic {

class Random {
  public:
    Random(uint64_t seed, std::string_view stream);

    /// Uniformly distributed in [low, high).
    double uniform(double low, double high);
    /// Normally distributed, with mean 0 and standard deviation 1.
    double normal();

  private:
    std::mt19937_64 engine_;
};

}  // namespace dihaptic
