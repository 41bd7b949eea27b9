#include "model/adaptation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/learning_curve.h"

namespace dihaptic::model::adaptation_test {
namespace {

using Trials = std::vector<AdaptationTrial>;

void add(Trials& trials, int count, AdaptationTrial trial) {
    trials.insert(trials.end(), static_cast<size_t>(count), trial);
}

/// 64 aligned trials, 160 trials rotated by 30 degrees, 16 rotated by -30 degrees, and 48 error
/// clamps.
Trials rotation_schedule() {
    Trials trials;
    add(trials, 64, {0});
    add(trials, 160, {30});
    add(trials, 16, {-30});
    add(trials, 48, {0, true});
    return trials;
}

struct Figures {
    double end, first_clamp, peak, last;
    long trials_to_80, peak_trial;
};

Figures figures(const TwoRate& rates) {
    const auto x = compensation(rates, rotation_schedule());
    const auto peak = std::max_element(x.begin() + 240, x.end());
    const auto reached =
        std::find_if(x.begin() + 64, x.end(), [&](double y) { return y >= 0.8 * x[223]; });
    return {
        x[223], x[240], *peak, x.back(), reached - x.begin() - 64 + 1, peak - x.begin() - 240 + 1};
}

TEST(TwoRate, GivesTheFiguresOfSmithsValuesToThePrintedDigit) {
    const Figures smith = figures(kSmith2006);
    EXPECT_NEAR(smith.end, 22.1, 0.05);
    EXPECT_EQ(smith.trials_to_80, 44);
    EXPECT_NEAR(smith.first_clamp, -5.8, 0.05);
    EXPECT_NEAR(smith.peak, 6.4, 0.05);
    EXPECT_EQ(smith.peak_trial, 10);
    EXPECT_NEAR(smith.last, 4.8, 0.05);
}

TEST(TwoRate, GivesTheFiguresOfAGroupOfPeopleToThePrintedDigit) {
    const Figures group = figures({.fast = {0.657, 0.239}, .slow = {0.9987, 0.0292}});
    EXPECT_NEAR(group.end, 27.9, 0.05);
    EXPECT_EQ(group.trials_to_80, 50);
    EXPECT_NEAR(group.first_clamp, -6.0, 0.05);
    EXPECT_NEAR(group.peak, 11.4, 0.05);
    EXPECT_EQ(group.peak_trial, 16);
    EXPECT_NEAR(group.last, 11.0, 0.05);
}

TEST(TwoRate, InAClampEachStateDecaysByItself) {
    Trials trials;
    add(trials, 50, {1});
    const TwoRateState before = [&] {
        TwoRateState state;
        for (const auto& trial : trials)
            state = next(kSmith2006, state, adaptation_error(trial, state.output()));
        return state;
    }();
    add(trials, 20, {1, true});
    const auto x = compensation(kSmith2006, trials);
    for (int n = 0; n < 20; ++n)
        EXPECT_NEAR(x[50 + static_cast<size_t>(n)],
                    before.fast * std::pow(0.59, n) + before.slow * std::pow(0.992, n), 1e-14);
}

TEST(TwoRate, RecoversSpontaneouslyTowardWhatWasLearnedFirst) {
    const auto x = compensation(kSmith2006, rotation_schedule());
    EXPECT_LT(x[240], 0);
    EXPECT_GT(*std::max_element(x.begin() + 240, x.end()), 5);
    // a single-rate process shows no spontaneous recovery
    const auto single = compensation(SingleRate{0.99, 0.1}, rotation_schedule());
    for (size_t n = 241; n < single.size(); ++n)
        EXPECT_LE(std::abs(single[n]), std::abs(single[n - 1]));
}

TEST(TwoRate, LearnsFasterAgainAfterBeingTurnedBack) {
    Trials trials;
    add(trials, 160, {30});
    const auto first = compensation(kSmith2006, trials);
    // trained back until the output is near zero, while the slow state remembers the rotation
    add(trials, 7, {-30});
    const size_t again = trials.size();
    add(trials, 10, {30});
    const auto x = compensation(kSmith2006, trials);
    EXPECT_NEAR(x[again], 0, 3);
    for (size_t n = 1; n < 10; ++n) EXPECT_GT(x[again + n] - x[again], first[n]) << n;
}

TEST(TwoRate, ForgetsALittleInACatchTrialAndAllInALongWashout) {
    Trials trials;
    add(trials, 100, {30});
    add(trials, 1, {0});
    add(trials, 1, {30});
    const auto x = compensation(kSmith2006, trials);
    // a catch trial changes the output in the next trial, but not in the catch trial itself
    EXPECT_GT(x[100], x[99]);
    EXPECT_LT(x[101], x[100]);
    add(trials, 400, {0});
    EXPECT_NEAR(compensation(kSmith2006, trials).back(), 0, 0.01);
}

TEST(Adaptation, EndsAtItsAsymptote) {
    const Trials trials(5000, AdaptationTrial{30});
    EXPECT_NEAR(compensation(kSmith2006, trials).back(), 30 * asymptote(kSmith2006), 1e-9);
    const SingleRate rate{0.95, 0.2};
    EXPECT_NEAR(compensation(rate, trials).back(), 30 * asymptote(rate), 1e-9);
    EXPECT_NEAR(asymptote(rate), 0.2 / (1 - 0.95 + 0.2), 1e-15);
    EXPECT_EQ(asymptote(SingleRate{1, 0.1}), 1);
    EXPECT_EQ(asymptote(SingleRate{1, 0}), 0);
    EXPECT_EQ(asymptote(TwoRate{{0.6, 0.2}, {1, 0.02}}), 1);
}

TEST(LearningCurve, IsThatOfASingleRate) {
    const SingleRate rate{0.97, 0.12};
    const LearningCurve curve = learning_curve(rate, 30);
    const auto x = compensation(rate, Trials(100, AdaptationTrial{30}));
    for (size_t n = 0; n < x.size(); ++n)
        EXPECT_NEAR(x[n], curve.at(static_cast<double>(n)), 1e-12);
}

}  // namespace
}  // namespace dihaptic::model::adaptation_test
