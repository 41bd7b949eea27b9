// The statistic of a custom measure's values over the ticks of an attempt.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "task/plan/measures.h"

namespace dihaptic::task {

/// Collects values and computes a statistic. It does not allocate, except for the median.
class Taken {
  public:
    explicit Taken(Take take) : take_(take) {}
    /// Adds a value, unless it is unmeasured.
    void add(double value);
    /// Returns the statistic, or NaN if no value was added.
    double statistic() const;
    void clear() { *this = Taken(take_); }

  private:
    Take take_;
    int64_t ticks_ = 0;
    double value_ = 0;  // first, last, smallest or largest value, or mean, depending on `take_`
    double mean_ = 0;   // mean, used for the standard deviation
    // sum of squares: of the values (rms), or of their deviations from the mean (sd)
    double squares_ = 0;
    std::vector<double> all_;  // all values, used for the median
};

/// Returns the median; for an even number of values, this is the mean of the middle two. Reorders
/// the values. Returns NaN if there are no values.
double median_of(std::span<double> x) noexcept;

}  // namespace dihaptic::task
