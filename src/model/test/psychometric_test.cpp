#include "model/psychometric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace dihaptic::model::psychometric_test {
namespace {

const std::vector<Psychometric> kFunctions = {
    {Sigmoid::normal, 1.5, 0.4, 0.5, 0.02},
    {Sigmoid::logistic, -2, 0.7, 0, 0},
    {Sigmoid::weibull, 0.005, 3.7, 0.25, 0.04},
    {Sigmoid::weibull_log10, -1.2, 3.5, 0.5, 0.01},
};

TEST(Psychometric, HasTheValuesOfTheTables) {
    const double e = std::numbers::e;
    const Psychometric normal{Sigmoid::normal, 3, 2};
    EXPECT_DOUBLE_EQ(normal.probability(3), 0.5);
    EXPECT_NEAR(normal.probability(3 + 2 * 1.959963984540054), 0.975, 1e-15);
    EXPECT_NEAR(normal.probability(1), 0.15865525393145705, 1e-15);
    EXPECT_NEAR((Psychometric{Sigmoid::logistic, 3, 2}.probability(5)), e / (1 + e), 1e-15);
    EXPECT_NEAR((Psychometric{Sigmoid::weibull, 3, 2}.probability(3)), 1 - 1 / e, 1e-15);
    EXPECT_NEAR((Psychometric{Sigmoid::weibull, 3, 2}.probability(6)), 1 - std::exp(-4.0), 1e-15);
    EXPECT_EQ((Psychometric{Sigmoid::weibull, 3, 2, 0.5}.probability(-1)), 0.5);
}

TEST(Psychometric, OfALogarithmIsWeibull) {
    const Psychometric linear{Sigmoid::weibull, 0.3, 3.5, 0.5, 0.01};
    const Psychometric logarithmic{Sigmoid::weibull_log10, std::log10(0.3), 3.5, 0.5, 0.01};
    for (double x = 0.05; x < 1; x += 0.05)
        EXPECT_NEAR(linear.probability(x), logarithmic.probability(std::log10(x)), 1e-14);
}

TEST(Psychometric, RisesFromGuessToLapse) {
    for (const Psychometric& f : kFunctions) {
        EXPECT_NEAR(f.probability(f.threshold - 100 * f.sd()), f.guess, 1e-12);
        EXPECT_NEAR(f.probability(f.threshold + 100 * f.sd()), 1 - f.lapse, 1e-12);
    }
}

TEST(Psychometric, InverseUndoesIt) {
    for (const Psychometric& f : kFunctions) {
        for (double share = 0.001; share < 1; share += 0.0499) {
            const double p = f.guess + (1 - f.guess - f.lapse) * share;
            EXPECT_NEAR(f.probability(f.level(p)), p, 1e-13);
        }
        EXPECT_TRUE(std::isnan(f.level(f.guess)));
        EXPECT_TRUE(std::isnan(f.level(1 - f.lapse)));
        EXPECT_TRUE(std::isnan(f.level(1.1)));
    }
}

TEST(Psychometric, StandardDeviationIsThatOfItsDistribution) {
    for (Psychometric f : kFunctions) {
        f.guess = f.lapse = 0;
        // computes the means of x and x^2 by integrating the quantile function
        const int n = 200000;
        double mean = 0, square = 0;
        for (int i = 0; i < n; ++i) {
            const double x = f.level((i + 0.5) / n);
            mean += x / n;
            square += x * x / n;
        }
        EXPECT_NEAR(std::sqrt(square - mean * mean) / f.sd(), 1, 1e-4);
    }
}

}  // namespace
}  // namespace dihaptic::model::psychometric_test
