// The statistic of a custom measure's values in the ticks of an attempt.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "task/plan/measures.h"

namespace dihaptic::task {

/// Collects the values and computes the statistic; allocates nothing, except for the median.
class Taken {
  public:
    explicit Taken(Take take) : take_(take) {}
    /// Adds a value; unmeasured values are ignored.
    void add(double value);
    /// The statistic; NaN if no value was added.
    double statistic() const;
    void clear() { *this = Taken(take_); }

  private:
    Take take_;
    int64_t ticks_ = 0;
    double value_ = 0;         // first, last, least, largest, or mean
    double mean_ = 0;          // for the SD
    double squares_ = 0;       // sum, of the values (rms) or of deviations from the mean (SD)
    std::vector<double> all_;  // all values, for the median
};

/// The median; for an even number of values, the mean of the middle two. Reorders the values; NaN
/// if there are none.
double median_of(std::span<double> x) noexcept;

}  // namespace dihaptic::task
