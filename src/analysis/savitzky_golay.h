// Derivatives of a sampled signal from the cubic that fits a window around each sample best
// (Savitzky and Golay 1964). Near the ends the window is the first or the last one that fits.
#pragma once

#include <span>
#include <vector>

namespace dihaptic::analysis {

/// The derivative of that order, 0 (the smoothed signal) to 3, in units of the signal over
/// s^order. `window`: length [s], at least four samples; a signal that is shorter has zeros.
std::vector<double> savitzky_golay(std::span<const double> signal, double tick, double window,
                                   int order);

}  // namespace dihaptic::analysis
