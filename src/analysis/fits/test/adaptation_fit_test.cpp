#include "analysis/fits/two_rate_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"
#include "base/number.h"
#include "base/random.h"

namespace dihaptic::analysis::adaptation_fit_test {
namespace {

using model::AdaptationTrial;
using model::SingleRate;
using model::TwoRate;

/// 64 aligned trials, 160 trials rotated by 30 degrees, 16 rotated by -30 degrees, and 48 error
/// clamps.
std::vector<AdaptationTrial> schedule() {
    std::vector<AdaptationTrial> trials(64);
    trials.insert(trials.end(), 160, {30});
    trials.insert(trials.end(), 16, {-30});
    trials.insert(trials.end(), 48, {0, true});
    return trials;
}

std::vector<double> with_noise(std::vector<double> x, double sd, Random& random) {
    for (double& y : x) y += sd * random.normal();
    return x;
}

double mean_square(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    int count = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        if (std::isnan(a[i])) continue;
        sum += (a[i] - b[i]) * (a[i] - b[i]);
        ++count;
    }
    return sum / count;
}

bool holds(const Interval& interval, double value) {
    return interval.low <= value && value <= interval.high;
}

TEST(TwoRateFit, FindsExactDataAgain) {
    const auto trials = schedule();
    const auto fit = fit_two_rate(compensation(model::kSmith2006, trials), trials);
    EXPECT_NEAR(fit.rates.fast.retention, 0.59, 1e-3);
    EXPECT_NEAR(fit.rates.fast.learning, 0.21, 1e-3);
    EXPECT_NEAR(fit.rates.slow.retention, 0.992, 1e-4);
    EXPECT_NEAR(fit.rates.slow.learning, 0.02, 1e-4);
    EXPECT_LT(fit.mean_square, 1e-8);
}

TEST(TwoRateFit, OfPeopleIsNoWorseThanTheTruthAndPredictsIt) {
    // parameters as found in people (medians and quartiles), with a residual SD of 6.6 degrees
    const auto trials = schedule();
    const double noise = 6.6;
    Random random(11, "people");
    const int people = 16;
    int held[4] = {};
    double curve_error = 0;
    for (int i = 0; i < people; ++i) {
        const TwoRate truth{{random.uniform(0.45, 0.75), random.uniform(0.15, 0.45)},
                            {random.uniform(0.985, 0.9995), random.uniform(0.02, 0.06)}};
        const auto exact = compensation(truth, trials);
        const auto measured = with_noise(exact, noise, random);
        const auto fit = fit_two_rate(measured, trials);
        EXPECT_LE(fit.mean_square, mean_square(measured, exact)) << i;
        EXPECT_NEAR(fit.residual_sd, noise, 0.2 * noise);
        // p fitted parameters leave an error of SD sqrt(p / n) = 0.78 degrees in the curve
        EXPECT_LT(std::sqrt(mean_square(exact, fit.predicted)), 2.0) << i;
        curve_error += mean_square(exact, fit.predicted) / people;
        held[0] += holds(fit.retention_fast, truth.fast.retention) ? 1 : 0;
        held[1] += holds(fit.learning_fast, truth.fast.learning) ? 1 : 0;
        held[2] += holds(fit.retention_slow, truth.slow.retention) ? 1 : 0;
        held[3] += holds(fit.learning_slow, truth.slow.learning) ? 1 : 0;
        EXPECT_LE(fit.rates.fast.retention, fit.rates.slow.retention);
        EXPECT_GE(fit.rates.fast.learning, fit.rates.slow.learning);
        EXPECT_TRUE(holds(fit.retention_fast, fit.rates.fast.retention));
        EXPECT_TRUE(holds(fit.learning_slow, fit.rates.slow.learning));
    }
    EXPECT_LT(std::sqrt(curve_error), 1.0);
    for (const int count : held) EXPECT_GE(count, people - 3);
    RecordProperty("curve_rms_deg", number_text(std::sqrt(curve_error)));
    for (int i = 0; i < 4; ++i) RecordProperty("held_" + number_text(i), number_text(held[i]));
}

TEST(TwoRateFit, IgnoresTrialsThatWereNotMeasured) {
    const auto trials = schedule();
    auto measured = compensation(model::kSmith2006, trials);
    for (size_t i = 0; i < measured.size(); i += 7) measured[i] = NAN;
    const auto fit = fit_two_rate(measured, trials);
    EXPECT_LT(fit.mean_square, 1e-8);
    EXPECT_EQ(fit.predicted.size(), trials.size());
}

TEST(SingleRateFit, RecoversWhatWasPutIn) {
    const auto trials = schedule();
    const SingleRate truth{0.97, 0.12};
    const auto exact = compensation(truth, trials);
    const auto fit = fit_single_rate(exact, trials);
    EXPECT_NEAR(fit.rate.retention, 0.97, 1e-5);
    EXPECT_NEAR(fit.rate.learning, 0.12, 1e-5);

    Random random(2, "people");
    const int people = 60;
    double retention = 0, learning = 0;
    int held = 0;
    for (int i = 0; i < people; ++i) {
        const auto noisy = fit_single_rate(with_noise(exact, 5, random), trials);
        retention += noisy.rate.retention / people;
        learning += noisy.rate.learning / people;
        held += holds(noisy.retention, 0.97) && holds(noisy.learning, 0.12) ? 1 : 0;
    }
    EXPECT_NEAR(retention, 0.97, 0.003);
    EXPECT_NEAR(learning, 0.12, 0.005);
    EXPECT_GE(held, people * 8 / 10);
}

TEST(SingleRateFit, CannotExplainARebound) {
    const auto trials = schedule();
    const auto measured = compensation(model::kSmith2006, trials);
    EXPECT_GT(fit_single_rate(measured, trials).mean_square,
              1000 * fit_two_rate(measured, trials).mean_square);
}

TEST(LearningCurveFit, RecoversWhatWasPutIn) {
    const model::LearningCurve truth{2, 25, 12};
    std::vector<double> exact;
    for (int n = 0; n < 80; ++n) exact.push_back(truth.at(n));
    const auto fit = fit_learning_curve(exact);
    EXPECT_NEAR(fit.curve.start, 2, 1e-4);
    EXPECT_NEAR(fit.curve.asymptote, 25, 1e-4);
    EXPECT_NEAR(fit.curve.time_constant, 12, 1e-3);

    Random random(2, "people");
    const int people = 60;
    double start = 0, asymptote = 0, time_constant = 0;
    int held[3] = {};
    for (int i = 0; i < people; ++i) {
        const auto noisy = fit_learning_curve(with_noise(exact, 3, random));
        start += noisy.curve.start / people;
        asymptote += noisy.curve.asymptote / people;
        time_constant += noisy.curve.time_constant / people;
        held[0] += holds(noisy.start, truth.start) ? 1 : 0;
        held[1] += holds(noisy.asymptote, truth.asymptote) ? 1 : 0;
        held[2] += holds(noisy.time_constant, truth.time_constant) ? 1 : 0;
    }
    EXPECT_NEAR(start, 2, 0.5);
    EXPECT_NEAR(asymptote, 25, 0.3);
    EXPECT_NEAR(time_constant, 12, 0.7);
    for (const int count : held) EXPECT_GE(count, people * 87 / 100);
}

TEST(LearningCurveFit, AlsoFalls) {
    std::vector<double> x;
    for (int n = 0; n < 60; ++n) x.push_back(model::LearningCurve{30, 4, 5}.at(n));
    EXPECT_NEAR(fit_learning_curve(x).curve.time_constant, 5, 1e-3);
}

TEST(AdaptationFit, RefusesTooLittle) {
    const std::vector<AdaptationTrial> trials(4, {30});
    EXPECT_THROW(fit_two_rate(std::vector<double>{1, 2, 3}, trials), Error);
    EXPECT_THROW(fit_two_rate(std::vector<double>{1, 2, 3, NAN}, trials), Error);
    EXPECT_THROW(fit_single_rate(std::vector<double>{1, NAN, NAN, 2}, trials), Error);
    EXPECT_THROW(fit_learning_curve(std::vector<double>{1, 2, 3}), Error);
    EXPECT_THROW(fit_learning_curve(std::vector<double>{}), Error);
}

}  // namespace
}  // namespace dihaptic::analysis::adaptation_fit_test
