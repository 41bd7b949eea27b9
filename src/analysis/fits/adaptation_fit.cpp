#include "analysis/fits/adaptation_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/diagnostics.h"

namespace dihaptic::analysis {
namespace {

using model::AdaptationTrial;
using model::SingleRate;

using Prediction = std::function<std::vector<double>(std::span<const double>)>;

/// Fits a prediction with bounded parameters by least squares, from several starting points, and
/// computes its profiles.
class LeastSquares {
  public:
    LeastSquares(std::span<const double> measured, Prediction predict, std::vector<Variable> ranges)
        : measured_(measured), predict_(std::move(predict)), ranges_(std::move(ranges)) {
        for (const double y : measured) count_ += std::isnan(y) ? 0 : 1;
    }

    /// Runs the fit from the three best of the starting points.
    void run(std::vector<std::vector<double>> starts) {
        if (count_ <= starts.front().size())
            throw Error("too few trials were measured to fit a curve",
                        "measure more trials than the model has parameters");
        std::sort(starts.begin(), starts.end(),
                  [this](const auto& a, const auto& b) { return cost(a) < cost(b); });
        starts.resize(std::min<size_t>(starts.size(), 3));
        const Cost all = [this](std::span<const double> x) { return cost(x); };
        for (const auto& start : starts) {
            const Minimum found = minimise(all, ranges_, start);
            if (best_.x.empty() || found.value < best_.value) best_ = found;
        }
    }

    const std::vector<double>& best() const { return best_.x; }

    CurveFit curve_fit() const {
        const auto n = static_cast<double>(count_);
        const auto p = static_cast<double>(best_.x.size());
        return {predict_(best_.x), best_.value / n, std::sqrt(best_.value / (n - p))};
    }

    Interval interval(int parameter) const {
        const auto i = static_cast<size_t>(parameter);
        const double freedom = static_cast<double>(count_) - static_cast<double>(best_.x.size());
        // noise-free data have no residuals, and the limit would be 0
        const double limit = std::max(best_.value, 1e-20) * std::exp(kChiSquared95 / freedom);
        return profile_interval([&](double v) { return profile(parameter, v); }, best_.x[i],
                                ranges_[i], limit);
    }

  private:
    double cost(std::span<const double> x) const {
        const std::vector<double> y = predict_(x);
        double sum = 0;
        for (size_t i = 0; i < y.size(); ++i)
            if (!std::isnan(measured_[i])) sum += (measured_[i] - y[i]) * (measured_[i] - y[i]);
        return sum;
    }

    /// Returns the lowest cost with one parameter held at v.
    double profile(int parameter, double v) const {
        const auto i = static_cast<std::ptrdiff_t>(parameter);
        auto variables = ranges_;
        std::vector<double> start = best_.x;
        variables.erase(variables.begin() + i);
        start.erase(start.begin() + i);
        std::vector<double> all = best_.x;
        all[static_cast<size_t>(i)] = v;
        const Cost rest = [&](std::span<const double> x) {
            std::copy(x.begin(), x.begin() + i, all.begin());
            std::copy(x.begin() + i, x.end(), all.begin() + i + 1);
            return cost(all);
        };
        return minimise(rest, variables, start).value;
    }

    std::span<const double> measured_;
    Prediction predict_;
    std::vector<Variable> ranges_;
    size_t count_ = 0;
    Minimum best_;
};

}  // namespace

void check_numbers(std::span<const double> measured, std::span<const AdaptationTrial> trials) {
    if (measured.size() != trials.size())
        throw Error("the number of measurements differs from the number of trials",
                    "give one per trial, NaN if it is missing");
}

LearningCurveFit fit_learning_curve(std::span<const double> measured) {
    double low = INFINITY, high = -INFINITY;
    for (const double y : measured) {
        if (std::isnan(y)) continue;
        low = std::min(low, y);
        high = std::max(high, y);
    }
    const double span = std::max(high - low, 1e-12);
    const auto curve = [](std::span<const double> x) {
        return model::LearningCurve{x[0], x[1], std::exp(x[2])};
    };
    const auto trials = static_cast<double>(measured.size());
    const std::vector<Variable> ranges = {{low - 10 * span, high + 10 * span},
                                          {low - 10 * span, high + 10 * span},
                                          {std::log(0.1), std::log(std::max(1.0, 10 * trials))}};
    LeastSquares search(
        measured,
        [&](std::span<const double> x) {
            std::vector<double> y(measured.size());
            for (size_t i = 0; i < y.size(); ++i) y[i] = curve(x).at(static_cast<double>(i));
            return y;
        },
        ranges);
    std::vector<std::vector<double>> starts;
    for (const double share : {0.01, 0.03, 0.1, 0.3, 1.0}) {
        const double tau = std::log(std::max(0.2, share * trials));
        starts.push_back({low, high, tau});
        starts.push_back({high, low, tau});
    }
    search.run(std::move(starts));
    LearningCurveFit fit{search.curve_fit(), curve(search.best()), {}, {}, {}};
    fit.start = search.interval(0);
    fit.asymptote = search.interval(1);
    const Interval log_tau = search.interval(2);
    fit.time_constant = {std::exp(log_tau.low), std::exp(log_tau.high)};
    return fit;
}

SingleRateFit fit_single_rate(std::span<const double> measured,
                              std::span<const AdaptationTrial> trials) {
    check_numbers(measured, trials);
    LeastSquares search(
        measured,
        [&](std::span<const double> x) {
            return compensation(SingleRate{x[0], x[1]}, trials);
        },
        std::vector<Variable>(2, Variable{0, 1}));
    std::vector<std::vector<double>> starts;
    for (const double retention : {0.5, 0.9, 0.98, 0.999})
        for (const double learning : {0.02, 0.1, 0.3}) starts.push_back({retention, learning});
    search.run(std::move(starts));
    const auto& x = search.best();
    return {search.curve_fit(), {x[0], x[1]}, search.interval(0), search.interval(1)};
}

}  // namespace dihaptic::analysis
