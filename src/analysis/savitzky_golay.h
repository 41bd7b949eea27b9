// Computes derivatives of a sampled signal, using the cubic that best fits a window around each
// sample (Savitzky and Golay 1964). Near the ends of the signal, the first or the last full window
// is used.
#pragma once

#include <span>
#include <vector>

namespace dihaptic::analysis {

/// Returns the derivative of order 0 (the smoothed signal) to 3, in units of the signal over
/// s^order. `window`: length of the window [s], which must cover at least four samples. If the
/// signal is shorter than the window, returns 0 for every sample.
std::vector<double> savitzky_golay(std::span<const double> signal, double tick, double window,
                                   int order);

}  // namespace dihaptic::analysis
