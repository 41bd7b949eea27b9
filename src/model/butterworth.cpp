#include "model/butterworth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dihaptic::model {
namespace {

struct Biquad {
    double b0, b1, b2, a1, a2;

    /// Runs the filter once, starting from the steady state for the first sample's value. `gain` is
    /// the filter's gain at 0 Hz.
    void run(std::vector<double>& x, double gain) const {
        double x1 = x.front(), x2 = x.front();
        double y1 = gain * x.front(), y2 = y1;
        for (double& sample : x) {
            const double y = b0 * sample + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
            x2 = x1;
            x1 = sample;
            y2 = y1;
            y1 = y;
            sample = y;
        }
    }
};

/// Runs both passes. The signal is first extended at both ends by its point reflection, so that the
/// filter has settled by the time the signal starts.
std::vector<double> both_ways(const std::vector<double>& signal, const Biquad& filter, double gain,
                              size_t pad) {
    if (signal.empty()) return {};
    if (signal.size() == 1) return {signal.front()};
    pad = std::min(pad, signal.size() - 1);
    std::vector<double> x;
    x.reserve(signal.size() + 2 * pad);
    for (size_t i = pad; i > 0; --i) x.push_back(2 * signal.front() - signal[i]);
    for (const double sample : signal) x.push_back(sample);
    for (size_t i = 1; i <= pad; ++i)
        x.push_back(2 * signal.back() - signal[signal.size() - 1 - i]);
    filter.run(x, gain);
    std::reverse(x.begin(), x.end());
    filter.run(x, gain);
    std::reverse(x.begin(), x.end());
    return {x.begin() + static_cast<std::ptrdiff_t>(pad),
            x.end() - static_cast<std::ptrdiff_t>(pad)};
}

size_t settling(double cutoff, double rate) {
    return static_cast<size_t>(std::ceil(2 * rate / cutoff));
}

}  // namespace

std::vector<double> low_pass(const std::vector<double>& signal, double cutoff, double rate) {
    const double k = std::tan(std::numbers::pi * cutoff / rate);
    const double norm = 1 / (1 + std::numbers::sqrt2 * k + k * k);
    const double b = k * k * norm;
    return both_ways(
        signal, {b, 2 * b, b, 2 * (k * k - 1) * norm, (1 - std::numbers::sqrt2 * k + k * k) * norm},
        1, settling(cutoff, rate));
}

std::vector<double> high_pass(const std::vector<double>& signal, double cutoff, double rate) {
    const double k = std::tan(std::numbers::pi * cutoff / rate);
    const double norm = 1 / (1 + std::numbers::sqrt2 * k + k * k);
    return both_ways(signal,
                     {norm, -2 * norm, norm, 2 * (k * k - 1) * norm,
                      (1 - std::numbers::sqrt2 * k + k * k) * norm},
                     0, settling(cutoff, rate));
}

}  // namespace dihaptic::model
