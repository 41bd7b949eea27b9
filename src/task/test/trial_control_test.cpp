// Tests that the program that decides about the next attempt is asked exactly once for each
// attempt, and that late answers are ignored.
#include "task/run/trial_control.h"

#include <gtest/gtest.h>

#include <thread>

#include "session/test/allocations.h"
#include "session/test/reaches.h"

namespace dihaptic::task::trial_control_test {
namespace {

Ended ended(int trial) {
    Ended out;
    out.trial = trial;
    return out;
}

Decision decision(int64_t number, int next) {
    Decision out;
    out.number = number;
    out.next = next;
    return out;
}

TEST(TrialControl, AnAnswerCountsForItsQuestionAlone) {
    TrialControl between(1, false);
    EXPECT_FALSE(between.question());
    between.ask(ended(1));
    const auto first = between.question();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->number, 1);
    EXPECT_EQ(first->trial, 1);
    EXPECT_FALSE(between.question()) << "it is taken once";
    EXPECT_EQ(between.answer(), nullptr) << "nobody has decided";
    between.ask(ended(2));
    between.decide(decision(first->number, 5));
    EXPECT_EQ(between.answer(), nullptr) << "that was about the previous trial";
    between.decide(decision(2, 7));
    ASSERT_NE(between.answer(), nullptr);
    EXPECT_EQ(between.answer()->next, 7);
}

TEST(TrialControl, ADecisionLeavesWhatItDoesNotName) {
    for (const double value : Decision{}.variables) EXPECT_TRUE(std::isnan(value));
}

TEST(TrialControl, OnTheVirtualClockTheDirectorWaits) {
    TrialControl between(1, true);
    between.ask(ended(1));
    std::jthread other([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        between.decide(decision(between.question()->number, 3));
    });
    const Decision* const answer = between.answer();
    ASSERT_NE(answer, nullptr);
    EXPECT_EQ(answer->next, 3);
}

/// This must hold in real time, even if nobody ever answers.
TEST(TrialControl, NoTickAllocatesOrWaits) {
    session::Files files;
    TrialControl between(0.1, false);
    session::expect_no_allocation(session::make_plan(files.request()), 120, &between);
    EXPECT_EQ(between.late(), 9) << "once before each trial";
}

TEST(TrialControl, NobodyIsWaitedForWhoHasLeft) {
    TrialControl between(1, true);
    between.ask(ended(1));
    between.leave();
    EXPECT_EQ(between.answer(), nullptr);
    EXPECT_TRUE(between.gone());
}

}  // namespace
}  // namespace dihaptic::task::trial_control_test
