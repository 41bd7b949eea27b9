// Derivatives of a sampled signal, from the cubic that best fits a window around each sample
// (Savitzky and Golay 1964). Near the ends, the first or the last whole window is used.
#pragma once

#include <span>
#include <vector>

namespace dihaptic::analysis {

/// The derivative of order 0 (the smoothed signal) to 3, in units of the signal over s^order.
/// `window`: length [s], at least four samples. For a signal shorter than the window, the
/// derivative is 0.
std::vector<double> savitzky_golay(std::span<const double> signal, double tick, double window,
                                   int order);

}  // namespace dihaptic::analysis
