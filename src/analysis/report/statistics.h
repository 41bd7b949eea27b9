// Figures of a sample, as papers give them. NaNs are left out; of too few values they are NaN.
#pragma once

#include <span>
#include <string>

#include "analysis/fits/minimise.h"

namespace dihaptic::analysis {

struct Sample {
    int count = 0;
    double mean = 0;
    double sd = 0;           ///< n - 1
    Interval mean_interval;  ///< 95 %, Student's
    double median = 0;
    Interval quartiles;
};

Sample sample(std::span<const double> values);

/// Half of the 95 % interval of the difference of two means, whose spreads may differ (Welch 1947).
double welch_half_width(const Sample& a, const Sample& b);

/// "0.12 to 0.34"; "-" where there is none
std::string in_words(const Interval& interval);

}  // namespace dihaptic::analysis
