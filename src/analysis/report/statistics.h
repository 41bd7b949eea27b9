// Statistics of a sample, as usually published. NaNs are left out; statistics that would be based
// on too few values are NaN.
#pragma once

#include <span>
#include <string>

#include "analysis/fits/minimise.h"

namespace dihaptic::analysis {

struct Sample {
    int count = 0;
    double mean = 0;
    double sd = 0;           ///< standard deviation, with the divisor n - 1
    Interval mean_interval;  ///< 95 % confidence interval of the mean, by Student's t
    double median = 0;
    Interval quartiles;
};

Sample sample(std::span<const double> values);

/// Half the width of the 95 % confidence interval for the difference between the means of two
/// samples whose spreads may differ (Welch 1947).
double welch_half_width(const Sample& a, const Sample& b);

/// Formats an interval, e.g. "0.12 to 0.34"; "-" if either end is NaN.
std::string in_words(const Interval& interval);

}  // namespace dihaptic::analysis
