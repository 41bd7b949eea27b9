// Statistics of a sample, as papers report them. NaNs are left out; statistics of too few values
// are NaN.
#pragma once

#include <span>
#include <string>

#include "analysis/fits/minimise.h"

namespace dihaptic::analysis {

struct Sample {
    int count = 0;
    double mean = 0;
    double sd = 0;           ///< standard deviation, with n - 1
    Interval mean_interval;  ///< 95 %, by Student's t
    double median = 0;
    Interval quartiles;
};

Sample sample(std::span<const double> values);

/// Half of the 95 % interval of the difference between two samples' means, whose spreads may differ
/// (Welch 1947).
double welch_half_width(const Sample& a, const Sample& b);

/// E.g. "0.12 to 0.34"; "-" if an end is NaN.
std::string in_words(const Interval& interval);

}  // namespace dihaptic::analysis
