#include "task/procedures/quest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/diagnostics.h"

namespace dihaptic::task::quest_test {
namespace {

TEST(Quest, RepeatsTheRunOfTheReferenceImplementation) {
    // answers of a run in which Pelli's QUEST, in PsychoPy, gave the levels below
    const std::string answers = "11011101110111101111";
    const double placements[] = {-0.647661, -1.106588, -1.474511, -0.581121, -0.831401};
    Quest quest({.prior_mean = -1, .prior_sd = 2, .trials = 20});
    for (size_t i = 0; i < answers.size(); ++i) {
        if (i < std::size(placements)) {
            EXPECT_NEAR(quest.level(), placements[i], 5e-7) << i;
        }
        if (i == 19) {
            EXPECT_NEAR(quest.level(), -0.888522, 5e-7);
        }
        EXPECT_FALSE(quest.done());
        quest.answer(quest.level(), answers[i] == '1');
    }
    EXPECT_TRUE(quest.done());
    EXPECT_NEAR(quest.estimate().threshold, -0.891116, 5e-7);
    EXPECT_NEAR(quest.sd(), 0.155460, 5e-7);
    const auto& p = quest.posterior();
    const auto mode = std::max_element(p.begin(), p.end()) - p.begin();
    EXPECT_NEAR(quest.thresholds()[static_cast<size_t>(mode)], -0.92, 1e-12);
}

TEST(Quest, StartsFromItsPrior) {
    const Quest quest({.prior_mean = 0.3, .prior_sd = 0.5});
    EXPECT_NEAR(quest.estimate().threshold, 0.3, 1e-12);
    EXPECT_NEAR(quest.sd(), 0.5, 1e-5);
    // the quantiles are those of a normal distribution, to within half a grain
    EXPECT_NEAR(quest.estimate().low, 0.3 - 1.96 * 0.5, 0.006);
    EXPECT_NEAR(quest.estimate().high, 0.3 + 1.96 * 0.5, 0.006);
}

TEST(Quest, AnswersBeyondTheGridCountAsItsEnds) {
    Quest far({.prior_mean = 0}), end({.prior_mean = 0});
    far.answer(1e9, false);
    end.answer(2.5, false);
    EXPECT_EQ(far.posterior(), end.posterior());
}

TEST(Quest, RefusesSettingsThatMeanNothing) {
    const auto refused = [](QuestSettings s) { EXPECT_THROW(Quest{s}, Error); };
    refused({.prior_mean = NAN});
    refused({.prior_sd = 0});
    refused({.target = 0.5});
    refused({.target = 0.996});
    refused({.slope = -1});
    refused({.guess = 1});
    refused({.blind = 1});
    refused({.grain = 0});
    refused({.cells = 7});
    refused({.grain = 1e-4, .cells = 2});
    refused({.trials = 0});
}

}  // namespace
}  // namespace dihaptic::task::quest_test
