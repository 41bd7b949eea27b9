#include "analysis/report/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "base/unmeasured.h"

namespace dihaptic::analysis {
namespace {

/// Quantile of sorted values, interpolated linearly.
double quantile(const std::vector<double>& x, double share) {
    if (x.empty()) return kUnmeasured;
    const double at = share * static_cast<double>(x.size() - 1);
    const auto i = static_cast<size_t>(at);
    const size_t j = std::min(i + 1, x.size() - 1);
    return x[i] + (at - static_cast<double>(i)) * (x[j] - x[i]);
}

}  // namespace

Sample sample(std::span<const double> values) {
    std::vector<double> x;
    for (const double value : values) {
        if (std::isfinite(value)) x.push_back(value);
    }
    std::sort(x.begin(), x.end());
    const auto n = static_cast<double>(x.size());
    Sample out;
    out.count = static_cast<int>(x.size());
    double sum = 0;
    for (const double value : x) sum += value;
    out.mean = x.empty() ? kUnmeasured : sum / n;
    double square = 0;
    for (const double value : x) square += (value - out.mean) * (value - out.mean);
    out.sd = x.size() < 2 ? kUnmeasured : std::sqrt(square / (n - 1));
    out.mean_interval = {kUnmeasured, kUnmeasured};
    if (x.size() >= 2) {
        const boost::math::students_t student(n - 1);
        const double half = boost::math::quantile(student, 0.975) * out.sd / std::sqrt(n);
        out.mean_interval = {out.mean - half, out.mean + half};
    }
    out.median = quantile(x, 0.5);
    out.quartiles = {quantile(x, 0.25), quantile(x, 0.75)};
    return out;
}

double welch_half_width(const Sample& a, const Sample& b) {
    const double of_a = a.sd * a.sd / a.count;
    const double of_b = b.sd * b.sd / b.count;
    if (of_a + of_b <= 0) return 0;
    const double freedom =
        (of_a + of_b) * (of_a + of_b) / (of_a * of_a / (a.count - 1) + of_b * of_b / (b.count - 1));
    const boost::math::students_t student(freedom);
    return boost::math::quantile(student, 0.975) * std::sqrt(of_a + of_b);
}

std::string in_words(const Interval& interval) {
    if (std::isnan(interval.low) || std::isnan(interval.high)) return "-";
    return fmt::format("{:.3g} to {:.3g}", interval.low, interval.high);
}

}  // namespace dihaptic::analysis
