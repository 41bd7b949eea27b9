// Tests the properties that all kinds of procedures have in common.
#include "task/procedures/procedure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostics.h"
#include "base/random.h"

namespace dihaptic::task::procedure_test {
namespace {

const model::Psychometric kObserver{model::Sigmoid::weibull_log10, -0.9, 3.5, 0.5, 0.005};

std::vector<double> grid(double first, double last, double step) {
    std::vector<double> values;
    for (int i = 0; first + i * step < last + step / 2; ++i) values.push_back(first + i * step);
    return values;
}

struct Case {
    std::string name;
    Procedure procedure;
    double target;  ///< probability of "yes" at the threshold that the procedure estimates
};

std::vector<Case> cases() {
    const Staircase staircase({.down_after = 2,
                               .start = 0,
                               .steps_up = {0.3, 0.1},
                               .down_over_up = 0.5488,
                               .trials = 300,
                               .skipped_reversals = 4});
    const Quest quest({.prior_mean = -0.5, .prior_sd = 1, .trials = 100});
    const QuestPlus quest_plus({.levels = grid(-2, 0, 0.1),
                                .thresholds = grid(-2, 0, 0.05),
                                .shapes = {2, 3.5, 5},
                                .lapses = {0, 0.02},
                                .trials = 100});
    return {{"staircase", Procedure(staircase), settling_probability(2, 0.5488)},
            {"quest", Procedure(quest), 0.82},
            {"quest_plus", Procedure(quest_plus), kObserver.probability(kObserver.threshold)}};
}

struct Trial {
    double level;
    bool yes;
};

/// Runs a procedure until it is done, using the answers of an observer.
std::vector<Trial> run(Procedure& procedure, uint64_t seed) {
    Random random(seed, "observer");
    std::vector<Trial> trials;
    while (!procedure.done()) {
        const double x = procedure.level();
        trials.push_back({x, random.uniform(0, 1) < kObserver.probability(x)});
        procedure.answer(x, trials.back().yes);
    }
    return trials;
}

class AnyProcedure : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, AnyProcedure, testing::ValuesIn(cases()),
                         [](const auto& a_case) { return a_case.param.name; });

TEST_P(AnyProcedure, EndsNearTheThreshold) {
    double sum = 0;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        Procedure procedure = GetParam().procedure;
        run(procedure, seed);
        sum += procedure.estimate().threshold / 40;
    }
    EXPECT_NEAR(sum, kObserver.level(GetParam().target), 0.1 * kObserver.sd());
}

TEST_P(AnyProcedure, ProposesFiniteLevelsFromTheFirst) {
    Procedure procedure = GetParam().procedure;
    EXPECT_FALSE(procedure.done());
    for (const Trial& trial : run(procedure, 1)) EXPECT_TRUE(std::isfinite(trial.level));
}

TEST_P(AnyProcedure, MovesTowardTheAnswers) {
    Procedure yes = GetParam().procedure, no = GetParam().procedure;
    for (int i = 0; i < 4; ++i) {
        yes.answer(yes.level(), true);
        no.answer(no.level(), false);
    }
    EXPECT_LT(yes.level(), no.level());
}

TEST_P(AnyProcedure, ACopyGoesItsOwnWay) {
    Procedure original = GetParam().procedure;
    original.answer(original.level(), true);
    Procedure copy = original;
    const double level = original.level();
    for (int i = 0; i < 5; ++i) copy.answer(copy.level(), false);
    EXPECT_EQ(original.level(), level);
    EXPECT_NE(copy.level(), level);
}

TEST_P(AnyProcedure, TheSameAnswersMakeTheSameStateFromAnyTrialOn) {
    Procedure once = GetParam().procedure;
    const auto trials = run(once, 7);
    for (const size_t crash : {size_t{0}, size_t{1}, trials.size() / 2, trials.size()}) {
        Procedure resumed = GetParam().procedure;
        for (size_t i = 0; i < crash; ++i) resumed.answer(trials[i].level, trials[i].yes);
        for (size_t i = crash; i < trials.size(); ++i) {
            EXPECT_EQ(resumed.level(), trials[i].level);
            resumed.answer(resumed.level(), trials[i].yes);
        }
        EXPECT_TRUE(resumed.done());
        EXPECT_EQ(resumed.estimate().threshold, once.estimate().threshold);
    }
}

TEST_P(AnyProcedure, HasItsThresholdInsideItsInterval) {
    Procedure procedure = GetParam().procedure;
    run(procedure, 1);
    const Estimate e = procedure.estimate();
    EXPECT_TRUE(std::isfinite(e.threshold));
    if (!std::isnan(e.low)) {
        EXPECT_LT(e.low, e.threshold);
        EXPECT_GT(e.high, e.threshold);
    }
}

TEST_P(AnyProcedure, RefusesWhatIsNoAnswer) {
    Procedure procedure = GetParam().procedure;
    EXPECT_THROW(procedure.answer(NAN, true), Error);
    EXPECT_THROW(procedure.answer(INFINITY, true), Error);
    run(procedure, 1);
    EXPECT_THROW(procedure.answer(0, true), Error);
}

}  // namespace
}  // namespace dihaptic::task::procedure_test
