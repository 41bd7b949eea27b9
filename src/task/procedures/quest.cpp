#include "task/procedures/quest.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"
#include "model/psychometric.h"
#include "task/procedures/posterior.h"

namespace dihaptic::task {
namespace {

/// Returns the psychometric function of the level relative to the threshold of the Weibull
/// function.
model::Psychometric weibull(const QuestSettings& s) {
    return {model::Sigmoid::weibull_log10, 0, s.slope, s.guess, s.blind * (1 - s.guess)};
}

/// Returns the psychometric function of the level relative to the level at which the probability is
/// `target`. The latter is interpolated linearly between grains, as in the original, so that runs
/// agree with other programs to the last printed digit.
model::Psychometric about_target(const QuestSettings& s) {
    model::Psychometric f = weibull(s);
    double x = -s.cells * s.grain, p = f.probability(x);
    for (int i = -s.cells + 1; i <= s.cells; ++i) {
        const double x_next = i * s.grain, p_next = f.probability(x_next);
        if (p_next >= s.target) {
            f.threshold = -(x + (x_next - x) * (s.target - p) / (p_next - p));
            break;
        }
        x = x_next;
        p = p_next;
    }
    return f;
}

void check(const QuestSettings& s) {
    Diagnostics problems;
    const auto require = [&](bool right, const char* key, const char* what, const char* remedy) {
        if (!right) problems.error({}, key, what, remedy);
    };
    const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
    require(std::isfinite(s.prior_mean), "prior_mean", "is not a number",
            "give the expected threshold, log10");
    require(positive(s.prior_sd), "prior_sd", "is not above 0", "give a generous spread");
    require(positive(s.slope), "slope", "is not above 0", "3.5 is usual");
    require(positive(s.grain), "grain", "is not above 0", "0.01 is usual");
    require(s.guess >= 0 && s.guess < 1, "guess", "is not in [0, 1)",
            "give the probability of a correct guess, e.g. 0.5 for two choices");
    require(s.blind >= 0 && s.blind < 1, "blind", "is not in [0, 1)", "0.01 is usual");
    require(s.target > s.guess && s.target < 1 - s.blind * (1 - s.guess), "target",
            "is not between the guess and lapse rates", "0.82 is usual for two choices");
    require(s.cells >= 2 && s.cells % 2 == 0, "cells", "is not an even number", "500 is usual");
    require(s.trials >= 1, "trials", "is below 1", "give the number of trials");
    problems.throw_if_errors();
    const model::Psychometric f = weibull(s);
    const double reach = s.grain * s.cells;
    if (f.probability(-reach) >= s.target || f.probability(reach) <= s.target)
        throw Error({}, "cells",
                    "times 'grain' is so small that the function does not reach 'target'",
                    "give more cells, or a coarser grain");
}

/// Returns the quantile of the posterior at which a trial is most informative, given the lower and
/// upper ends of the psychometric function (Pelli 1987). At this quantile, the two-outcome channel
/// with these ends reaches its capacity.
double most_informative_quantile(double low, double high) {
    const auto entropy = [](double p) {
        const auto part = [](double q) { return q > 0 ? -q * std::log(q) : 0.0; };
        return part(p) + part(1 - p);
    };
    const double p = 1 / (1 + std::exp((entropy(high) - entropy(low)) / (high - low)));
    return (p - low) / (high - low);
}

}  // namespace

Quest::Quest(const QuestSettings& settings) : settings_(settings) {
    check(settings_);
    const int half = settings_.cells / 2;
    for (int i = -half; i <= half; ++i) {
        const double x = i * settings_.grain;
        thresholds_.push_back(settings_.prior_mean + x);
        const double z = x / settings_.prior_sd;
        posterior_.push_back(std::exp(-0.5 * z * z));
    }
    normalise(posterior_);
    const model::Psychometric f = about_target(settings_);
    for (int i = -settings_.cells; i <= settings_.cells; ++i)
        yes_.push_back(f.probability(i * settings_.grain));
    best_quantile_ = most_informative_quantile(yes_.front(), yes_.back());
}

double Quest::level() const {
    return quantile(best_quantile_);
}

void Quest::answer(double level, bool yes) {
    ++trials_;
    const int half = settings_.cells / 2;
    const double grains =
        std::clamp((level - settings_.prior_mean) / settings_.grain, -1.0 * half, 1.0 * half);
    const int nearest = static_cast<int>(std::lround(grains));
    for (int i = -half; i <= half; ++i) {
        const double p = yes_[static_cast<size_t>(settings_.cells + nearest - i)];
        posterior_[static_cast<size_t>(i + half)] *= likelihood(p, yes);
    }
    normalise(posterior_);
}

Estimate Quest::estimate() const {
    return {mean(thresholds_, posterior_), quantile(0.025), quantile(0.975)};
}

double Quest::sd() const {
    const double m = mean(thresholds_, posterior_);
    double square = 0;
    for (size_t i = 0; i < posterior_.size(); ++i)
        square += posterior_[i] * (thresholds_[i] - m) * (thresholds_[i] - m);
    return std::sqrt(square);
}

double Quest::quantile(double share) const {
    return task::quantile(thresholds_, posterior_, share);
}

}  // namespace dihaptic::task
