#include "analysis/error_scale.h"

#include <cmath>
#include <limits>

namespace dihaptic::analysis {
namespace {

/// The regression line y = c + k g through the measured values, and the sum of its squared
/// residuals.
struct ErrorLine {
    ErrorScale scale;
    double squares = std::numeric_limits<double>::infinity();
};

ErrorLine line_of(std::span<const double> errors, std::span<const model::AdaptationTrial> trials,
                  std::span<const double> x) {
    double n = 0, mean_g = 0, mean_y = 0;
    const auto each = [&](auto use) {
        for (size_t i = 0; i < errors.size(); ++i) {
            if (!std::isnan(errors[i])) use(trials[i].perturbation - x[i], errors[i]);
        }
    };
    each([&](double g, double y) {
        ++n;
        mean_g += g;
        mean_y += y;
    });
    mean_g /= n;
    mean_y /= n;
    double gg = 0, gy = 0, yy = 0;
    each([&](double g, double y) {
        gg += (g - mean_g) * (g - mean_g);
        gy += (g - mean_g) * (y - mean_y);
        yy += (y - mean_y) * (y - mean_y);
    });
    constexpr double kParameters = 4;  // the parameters A, B, c and k
    if (!(gg > 0) || n <= kParameters) return {};
    ErrorLine out;
    out.scale.effect = gy / gg;
    out.scale.offset = mean_y - out.scale.effect * mean_g;
    out.squares = yy - gy * gy / gg;
    out.scale.standard_error = std::sqrt(std::fmax(0, out.squares) / (n - kParameters) / gg);
    return out;
}

}  // namespace

std::optional<ErrorScale> scale_of_errors(std::span<const double> errors,
                                          std::span<const model::AdaptationTrial> trials) {
    constexpr int kLeast = 10;
    constexpr int kSteps = 50;  // steps of the retention and of the learning rate, both from 0 to 1
    constexpr double kShows = 3.5;
    int measured = 0;
    for (const double error : errors) measured += !std::isnan(error);
    if (measured < kLeast || errors.size() != trials.size()) return std::nullopt;
    ErrorLine best;
    for (int a = 0; a <= kSteps; ++a) {
        for (int b = 0; b <= kSteps; ++b) {
            // finer near a retention of 1 and a learning rate of 0, where people's values lie
            const model::SingleRate rate{1 - std::pow(static_cast<double>(a) / kSteps, 2),
                                         std::pow(static_cast<double>(b) / kSteps, 2)};
            const ErrorLine line = line_of(errors, trials, model::compensation(rate, trials));
            if (line.squares < best.squares) best = line;
        }
    }
    const bool shows = std::abs(best.scale.effect) > kShows * best.scale.standard_error;
    if (!std::isfinite(best.squares) || !shows) return std::nullopt;
    return best.scale;
}

}  // namespace dihaptic::analysis
