#include "task/procedures/staircase.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostics.h"
#include "base/random.h"
#include "model/psychometric.h"

namespace dihaptic::task::staircase_test {
namespace {

/// Returns the levels of the trials with these answers ('1' for "yes"), followed by the next level.
std::vector<double> levels(Staircase& staircase, const std::string& answers) {
    std::vector<double> out = {staircase.level()};
    for (const char answer : answers) {
        staircase.answer(staircase.level(), answer == '1');
        out.push_back(staircase.level());
    }
    return out;
}

TEST(Staircase, GoesDownAfterKAndUpAfterOne) {
    Staircase staircase({.down_after = 2, .start = 10, .trials = 100});
    EXPECT_EQ(levels(staircase, "11110101101"),
              (std::vector<double>{10, 10, 9, 9, 8, 9, 9, 10, 10, 9, 10, 10}));
    // a minimum at 8, a maximum at 10, and a minimum at 9
    EXPECT_EQ(staircase.reversals(), (std::vector<double>{8, 10, 9}));
}

TEST(Staircase, StepsDifferUpAndDownAndByReversals) {
    Staircase staircase(
        {.down_after = 1, .start = 10, .steps_up = {4, 2, 1}, .down_over_up = 0.5, .trials = 100});
    EXPECT_EQ(levels(staircase, "11010000"),
              (std::vector<double>{10, 8, 6, 8, 7.5, 8.5, 9.5, 10.5, 11.5}));
    EXPECT_EQ(staircase.reversals(), (std::vector<double>{6, 8, 7.5}));
}

TEST(Staircase, ComesBackToTheSameNumbers) {
    Staircase staircase({.down_after = 1, .start = 0.8, .steps_up = {0.2}, .trials = 100});
    EXPECT_EQ(levels(staircase, "11110000"),
              (std::vector<double>{0.8, 0.6, 0.4, 0.2, 0, 0.2, 0.4, 0.6, 0.8}));
}

TEST(Staircase, StopsAtTheEndsOfItsRange) {
    Staircase staircase({.down_after = 1, .start = 1, .lowest = 0, .highest = 2, .trials = 100});
    EXPECT_EQ(levels(staircase, "111000"), (std::vector<double>{1, 0, 0, 0, 1, 2, 2}));
}

TEST(Staircase, IsDoneAfterReversalsOrTrials) {
    Staircase by_reversals({.down_after = 1, .reversals = 3});
    levels(by_reversals, "1010");
    EXPECT_TRUE(by_reversals.done());
    Staircase by_trials({.down_after = 1, .reversals = 3, .trials = 2});
    levels(by_trials, "1");
    EXPECT_FALSE(by_trials.done());
    levels(by_trials, "1");
    EXPECT_TRUE(by_trials.done());
}

TEST(Staircase, EstimatesFromAnEvenNumberOfReversals) {
    Staircase staircase({.down_after = 1, .start = 10, .trials = 100, .skipped_reversals = 1});
    levels(staircase, "110");
    EXPECT_TRUE(std::isnan(staircase.estimate().threshold));
    levels(staircase, "0110");  // reversals at 8, 10, 8
    EXPECT_EQ(staircase.estimate().threshold, 9);
    levels(staircase, "001");  // adds 11; the first of three is left out
    EXPECT_EQ(staircase.reversals(), (std::vector<double>{8, 10, 8, 11}));
    EXPECT_EQ(staircase.estimate().threshold, 9.5);
    EXPECT_TRUE(std::isnan(staircase.estimate().low));
}

TEST(Staircase, SettlesWhereThePublishedRatiosSay) {
    // published by Garcia-Perez (1998): 77.85, 80.35, 83.15, 85.84 % for 1- to 4-down
    const double published[] = {0.7785, 0.8035, 0.8315, 0.8584};
    for (int k = 1; k <= 4; ++k) {
        const double ratio = kGarciaPerez[static_cast<size_t>(k - 1)];
        EXPECT_NEAR(settling_probability(k, ratio), published[k - 1], 5e-5) << k;
        EXPECT_NEAR(down_over_up_for(k, settling_probability(k, ratio)), ratio, 1e-15);
    }
    // with equal steps: 50, 70.7, 79.4 %
    EXPECT_EQ(settling_probability(1, 1), 0.5);
    EXPECT_NEAR(settling_probability(2, 1), 0.707, 5e-4);
    EXPECT_NEAR(settling_probability(3, 1), 0.794, 5e-4);
    // Kaernbach (1991): with a step up that is three times the step down, 75 %
    EXPECT_DOUBLE_EQ(down_over_up_for(1, 0.75), 1.0 / 3);
}

/// Returns the probability of "yes" at the mean reversal of long staircases.
double probability_at_reversals(int k, double down_over_up, double step_up) {
    const model::Psychometric observer{model::Sigmoid::normal, 0, 1, 0.5, 0};
    Random random(5, "observer");
    Staircase staircase({.down_after = k,
                         .start = 1,
                         .steps_up = {step_up},
                         .down_over_up = down_over_up,
                         .trials = 200000,
                         .skipped_reversals = 10});
    while (!staircase.done()) {
        const double p = observer.probability(staircase.level());
        staircase.answer(staircase.level(), random.uniform(0, 1) < p);
    }
    return observer.probability(staircase.estimate().threshold);
}

TEST(Staircase, SettlesThereInSimulation) {
    for (int k = 1; k <= 4; ++k) {
        const double ratio = kGarciaPerez[static_cast<size_t>(k - 1)];
        for (const double step : {0.25, 0.5, 1.0})
            EXPECT_NEAR(probability_at_reversals(k, ratio, step), settling_probability(k, ratio),
                        0.012)
                << k << "-down, step " << step;
    }
    EXPECT_NEAR(probability_at_reversals(1, 1.0 / 3, 0.3), 0.75, 0.012);
}

TEST(Staircase, RefusesSettingsThatMeanNothing) {
    const auto refused = [](StaircaseSettings s) { EXPECT_THROW(Staircase{s}, Error); };
    refused({.down_after = 0, .trials = 10});
    refused({.start = NAN, .trials = 10});
    refused({.start = 5, .highest = 4, .trials = 10});
    refused({.steps_up = {}, .trials = 10});
    refused({.steps_up = {1, -1}, .trials = 10});
    refused({.down_over_up = 0, .trials = 10});
    refused({.lowest = 1, .highest = 1, .trials = 10});
    refused({});
    refused({.reversals = 5, .skipped_reversals = 4});
}

}  // namespace
}  // namespace dihaptic::task::staircase_test
