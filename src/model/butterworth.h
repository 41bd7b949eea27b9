// Second-order Butterworth filters, run forward and backward, so that there is no phase shift, and
// the magnitude response is squared: the cut-off frequency is attenuated by 6 dB. The filters are
// designed by the bilinear transform, with a pre-warped cut-off.
#pragma once

#include <vector>

namespace dihaptic::model {

/// Returns the part of the signal below `cutoff` [Hz]. `rate` is the sampling rate [Hz].
std::vector<double> low_pass(const std::vector<double>& signal, double cutoff, double rate);
/// Returns the part of the signal above `cutoff` [Hz].
std::vector<double> high_pass(const std::vector<double>& signal, double cutoff, double rate);

}  // namespace dihaptic::model
