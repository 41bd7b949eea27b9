#include "analysis/fits/psychometric_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"
#include "base/random.h"

namespace dihaptic::analysis::psychometric_fit_test {
namespace {

using model::Psychometric;
using model::Sigmoid;

/// The 2AFC example in psignifit's manual: 13 levels with 90 trials each.
const std::vector<LevelCount> kExample = {
    {0.0010, 45, 90}, {0.0015, 50, 90}, {0.0020, 44, 90}, {0.0025, 44, 90}, {0.0030, 52, 90},
    {0.0035, 53, 90}, {0.0040, 62, 90}, {0.0045, 64, 90}, {0.0050, 76, 90}, {0.0060, 79, 90},
    {0.0070, 88, 90}, {0.0080, 90, 90}, {0.0100, 90, 90}};

TEST(PsychometricFit, OfACumulativeGaussianToThePrintedDigit) {
    const auto fit = fit_psychometric(kExample, {.sigmoid = Sigmoid::normal, .max_lapse = 0});
    EXPECT_NEAR(fit.function.threshold, 0.004648, 5e-7);
    EXPECT_NEAR(fit.function.shape, 0.001416, 5e-7);
    EXPECT_NEAR(fit.negative_log_likelihood, 565.955, 5e-4);
    EXPECT_EQ(fit.function.lapse, 0);
    EXPECT_FALSE(fit.shape_unknown);
}

TEST(PsychometricFit, OfAWeibullToThePrintedDigit) {
    const auto fit = fit_psychometric(kExample, {.sigmoid = Sigmoid::weibull, .max_lapse = 0});
    EXPECT_NEAR(fit.function.threshold, 0.005156, 5e-7);
    EXPECT_NEAR(fit.function.shape, 3.6688, 5e-5);
    EXPECT_NEAR(fit.negative_log_likelihood, 565.860, 5e-4);
}

TEST(PsychometricFit, OfALogarithmIsTheSame) {
    auto logarithms = kExample;
    for (auto& c : logarithms) c.level = std::log10(c.level);
    const auto linear = fit_psychometric(kExample, {.sigmoid = Sigmoid::weibull});
    const auto log = fit_psychometric(logarithms, {.sigmoid = Sigmoid::weibull_log10});
    EXPECT_NEAR(linear.negative_log_likelihood, log.negative_log_likelihood, 1e-9);
    EXPECT_NEAR(std::log10(linear.function.threshold), log.function.threshold, 1e-6);
}

TEST(PsychometricFit, HasNoDevianceWhereItPassesThroughAllShares) {
    // with two levels and two parameters, the solution follows from inverting the sigmoid
    const std::vector<LevelCount> counts = {{1, 20, 100}, {3, 90, 100}};
    const auto fit =
        fit_psychometric(counts, {.sigmoid = Sigmoid::logistic, .guess = 0, .max_lapse = 0});
    const double a = std::log(0.2 / 0.8), b = std::log(0.9 / 0.1);
    EXPECT_NEAR(fit.function.shape, 2 / (b - a), 1e-5);
    EXPECT_NEAR(fit.function.threshold, 1 - a * 2 / (b - a), 1e-5);
    EXPECT_NEAR(fit.deviance, 0, 1e-8);
}

TEST(PsychometricFit, DevianceIsTwiceTheLogLikelihoodRatio) {
    const auto fit = fit_psychometric(kExample, {});
    double deviance = 0;
    for (const auto& c : kExample) {
        const double p = fit.function.probability(c.level);
        if (c.yes > 0) deviance += 2 * c.yes * std::log(c.yes / (c.trials * p));
        const int no = c.trials - c.yes;
        if (no > 0) deviance += 2 * no * std::log(no / (c.trials * (1 - p)));
    }
    EXPECT_NEAR(fit.deviance, deviance, 1e-8);
}

/// Random answers at nine levels, with `trials` answers at each level.
std::vector<LevelCount> answers(const Psychometric& f, int trials, Random& random) {
    std::vector<LevelCount> counts;
    for (double z = -2; z <= 2.01; z += 0.5) {
        const double x = f.threshold + z * f.sd();
        int yes = 0;
        for (int i = 0; i < trials; ++i) yes += random.uniform(0, 1) < f.probability(x) ? 1 : 0;
        counts.push_back({x, yes, trials});
    }
    return counts;
}

TEST(PsychometricFit, RecoversWhatWasPutIn) {
    const std::vector<std::pair<Psychometric, bool>> functions = {
        {{Sigmoid::normal, 2, 0.5, 0.5, 0.02}, false},
        {{Sigmoid::normal, -1, 3, 0.02, 0.02}, true},
        {{Sigmoid::logistic, 0, 1, 0, 0.03}, false},
        {{Sigmoid::weibull, 0.3, 2.5, 0.5, 0.01}, false},
        {{Sigmoid::weibull_log10, -1, 3.5, 0.25, 0.02}, false}};
    Random random(1, "observers");
    for (const auto& [f, guess_is_lapse] : functions) {
        double threshold = 0, shape = 0, lapse = 0;
        const int people = 40;
        for (int i = 0; i < people; ++i) {
            const auto fit = fit_psychometric(
                answers(f, 200, random),
                {.sigmoid = f.sigmoid, .guess = f.guess, .guess_is_lapse = guess_is_lapse});
            threshold += fit.function.threshold / people;
            shape += fit.function.shape / people;
            lapse += fit.function.lapse / people;
        }
        const int s = static_cast<int>(f.sigmoid);
        EXPECT_NEAR(threshold, f.threshold, 0.05 * f.sd()) << s;
        EXPECT_NEAR(shape / f.shape, 1, 0.05) << s;
        EXPECT_NEAR(lapse, f.lapse, 0.01) << s;
    }
}

/// Answers in a short staircase, for which the likelihood has many local maxima.
std::vector<LevelCount> short_staircase(double guess, Random& random) {
    const Psychometric truth{Sigmoid::normal, random.uniform(0.2, 0.6), random.uniform(0.05, 0.3),
                             guess, 0.02};
    std::vector<Answer> answers;
    double level = 0.8;
    int right = 0;
    for (int i = 0; i < 30; ++i) {
        const bool yes = random.uniform(0, 1) < truth.probability(level);
        answers.push_back({level, yes});
        right = yes ? right + 1 : 0;
        if (!yes) level = std::min(1.0, level + (i < 8 ? 0.2 : 0.1));
        if (right == 2) {
            level = std::max(0.0, level - (i < 8 ? 0.11 : 0.055));
            right = 0;
        }
    }
    return count(answers);
}

/// The lowest negative log likelihood on a dense grid of functions.
double least_on_grid(const std::vector<LevelCount>& counts, double guess) {
    double least = INFINITY;
    const double low = counts.front().level;
    const double span = counts.back().level - low;
    for (int t = -20; t <= 60; ++t) {
        for (int s = 0; s <= 40; ++s) {
            for (const double lapse : {0.0, 0.01, 0.02, 0.03, 0.05}) {
                const Psychometric f{Sigmoid::normal, low + span * t / 40.0,
                                     span * 2e-3 * std::pow(1.22, s), guess, lapse};
                double sum = 0;
                for (const LevelCount& c : counts) {
                    const double p = std::clamp(f.probability(c.level), 1e-12, 1 - 1e-12);
                    sum -= c.yes * std::log(p) + (c.trials - c.yes) * std::log1p(-p);
                }
                least = std::min(least, sum);
            }
        }
    }
    return least;
}

TEST(PsychometricFit, IsTheLikeliestOfAll) {
    Random random(7, "staircases");
    for (int i = 0; i < 60; ++i) {
        const double guess = i % 2 == 0 ? 0.5 : 0.02;
        const auto counts = short_staircase(guess, random);
        const auto fit = fit_psychometric(counts, {.guess = guess});
        EXPECT_LE(fit.negative_log_likelihood, least_on_grid(counts, guess) + 1e-6) << i;
    }
}

TEST(PsychometricFit, SaysWhenTheShapeCannotBeKnown) {
    const std::vector<LevelCount> step = {{1, 0, 20}, {2, 0, 20}, {3, 20, 20}, {4, 20, 20}};
    const auto fit = fit_psychometric(step, {.guess = 0, .max_lapse = 0});
    EXPECT_TRUE(fit.shape_unknown);
    EXPECT_GT(fit.function.threshold, 2);
    EXPECT_LT(fit.function.threshold, 3);
}

TEST(PsychometricFit, CountsAnswersByLevel) {
    const std::vector<Answer> series = {{2, true}, {1, false}, {2, false}, {1, false}, {2, true}};
    const auto counts = count(series);
    ASSERT_EQ(counts.size(), 2U);
    EXPECT_EQ(counts[0].level, 1);
    EXPECT_EQ(counts[0].yes, 0);
    EXPECT_EQ(counts[1].yes, 2);
    EXPECT_EQ(counts[1].trials, 3);
}

TEST(PsychometricFit, IntervalsHoldTheFit) {
    const PsychometricFitSettings settings;
    const auto fit = fit_psychometric(kExample, settings);
    const auto found = profile_intervals(kExample, fit, settings);
    EXPECT_LT(found.threshold.low, fit.function.threshold);
    EXPECT_GT(found.threshold.high, fit.function.threshold);
    EXPECT_LT(found.shape.low, fit.function.shape);
    EXPECT_GT(found.shape.high, fit.function.shape);
    EXPECT_GE(found.lapse.low, 0);
    EXPECT_LE(found.lapse.high, 0.05);
}

/// If all answers are far from the threshold, the other parameters cannot compensate for a lapse
/// rate above the proportion of wrong answers. Above that value, the profile is the likelihood of a
/// binomial distribution.
TEST(PsychometricFit, AnIntervalEndsWhereTheLikelihoodHasFallenByHalfOfChiSquared) {
    constexpr int kTrials = 1000;
    constexpr int kRight = 980;
    const std::vector<LevelCount> sure = {{-10, 0, kTrials}, {10, kRight, kTrials}};
    const PsychometricFitSettings settings{.guess = 0, .max_lapse = 0.1};
    const auto likelihood = [](double lapse) {
        return kRight * std::log1p(-lapse) + (kTrials - kRight) * std::log(lapse);
    };
    const auto fit = fit_psychometric(sure, settings);
    const double end = profile_intervals(sure, fit, settings).lapse.high;
    EXPECT_NEAR(2 * (likelihood(0.02) - likelihood(end)), kChiSquared95, 0.05) << end;
}

TEST(PsychometricFit, DevianceTellsGoodFitsFromBad) {
    const PsychometricFitSettings settings{.guess = 0, .max_lapse = 0.02};
    Random random(4, "observers");
    const auto share = [&](const std::vector<LevelCount>& counts, uint64_t seed) {
        return deviance_share(counts, fit_psychometric(counts, settings), settings, 200, seed);
    };
    const auto good = answers({Sigmoid::normal, 0, 1, 0, 0.01}, 100, random);
    EXPECT_GT(share(good, 1), 0.05);
    EXPECT_EQ(share(good, 1), share(good, 1));
    EXPECT_NE(share(good, 1), share(good, 2));
    // an observer who gives the opposite answers at one level in the middle
    auto bad = good;
    bad[2].yes = bad[2].trials - bad[2].yes;
    EXPECT_LT(share(bad, 1), 0.01);
}

TEST(PsychometricFit, RefusesWhatCannotBeFitted) {
    const auto refused = [](std::vector<LevelCount> counts, PsychometricFitSettings s = {}) {
        EXPECT_THROW(fit_psychometric(counts, s), Error);
    };
    refused({});
    refused({{1, 1, 2}});
    refused({{1, 1, 2}, {1, 2, 2}});
    refused({{1, 3, 2}, {2, 1, 2}});
    refused({{1, 0, 0}, {2, 1, 2}});
    refused({{NAN, 1, 2}, {2, 1, 2}});
    refused({{0, 1, 2}, {2, 1, 2}}, {.sigmoid = Sigmoid::weibull});
    refused({{1, 1, 2}, {2, 1, 2}}, {.guess = 0.96});
    refused({{1, 1, 2}, {2, 1, 2}}, {.max_lapse = -0.1});
}

}  // namespace
}  // namespace dihaptic::analysis::psychometric_fit_test
