// Quantiles of measured values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/unmeasured.h"

namespace dihaptic {

/// The quantile for the fraction `share`, taken at the nearest rank; NaN if there are no values. A
/// share of 0.5 gives the median; for an even number of values, this is the upper of the two middle
/// ones.
template <class T>
double quantile(std::vector<T> values, double share) {
    if (values.empty()) return kUnmeasured;
    const auto at =
        static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<size_t>(at)];
}

}  // namespace dihaptic
