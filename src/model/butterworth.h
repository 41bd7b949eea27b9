// Second-order Butterworth filters, run forward and backward: no phase shift, and the magnitude
// squared, so that the cut-off lies 6 dB down. Bilinear transform with the cut-off pre-warped.
#pragma once

#include <vector>

namespace dihaptic::model {

/// The signal below `cutoff` [Hz]; `rate` is samples per second [Hz].
std::vector<double> low_pass(const std::vector<double>& signal, double cutoff, double rate);
/// The signal above `cutoff` [Hz].
std::vector<double> high_pass(const std::vector<double>& signal, double cutoff, double rate);

}  // namespace dihaptic::model
