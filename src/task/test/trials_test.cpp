// Tests the order of trials, and which trials are repeated.
#include "task/plan/trials.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "session/test/reaches.h"

namespace dihaptic::task::trials_test {
namespace {

TEST(Order, ALatinSquarePutsEachItemInEachPlaceAndAfterEachOtherEquallyOften) {
    Random random(1, "test");
    for (const int n : {2, 3, 4, 5, 8}) {
        const int rows = n % 2 == 0 ? n : 2 * n;
        std::map<std::pair<int, int>, int> places;
        std::map<std::pair<int, int>, int> follows;
        for (int row = 0; row < rows; ++row) {
            const auto order = ordered(n, Order::latin_square, row, random);
            for (int i = 0; i < n; ++i) {
                ++places[{i, order[static_cast<size_t>(i)]}];
                if (i > 0)
                    ++follows[{order[static_cast<size_t>(i - 1)], order[static_cast<size_t>(i)]}];
            }
        }
        EXPECT_EQ(places.size(), static_cast<size_t>(n * n));
        EXPECT_EQ(follows.size(), static_cast<size_t>(n * (n - 1)));
        for (const auto& [which, count] : places) EXPECT_EQ(count, rows / n) << n;
        for (const auto& [which, count] : follows) EXPECT_EQ(count, rows / n) << n;
    }
}

TEST(Order, CounterbalancingGoesThroughAllPermutations) {
    Random random(1, "test");
    std::set<std::vector<int>> all;
    for (int number = 0; number < 24; ++number)
        all.insert(ordered(4, Order::counterbalanced, number, random));
    EXPECT_EQ(all.size(), 24u);
    EXPECT_EQ(ordered(4, Order::counterbalanced, 24, random), (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(participant_number("S07"), 7);
    EXPECT_EQ(participant_number("anna"), -1);
}

TEST(Order, TrialsHaveTheirKindsSharesAndInsertsAndTheSeedDecides) {
    session::Files files;
    const session::Plan plan = session::make_plan(files.request(3));
    const std::vector<Trial>& trials = plan.task->trials;
    ASSERT_EQ(trials.size(), 2u + 5u + 2u);
    int caught = 0;
    for (size_t i = 2; i < 7; ++i) {
        EXPECT_EQ(trials[i].number, 2);
        EXPECT_EQ(trials[i].in_block, static_cast<int>(i) - 1);
        caught += trials[i].kind == TrialKind::catch_trial;
        EXPECT_EQ(trials[i].perturb,
                  trials[i].kind == TrialKind::catch_trial ? std::vector<int>{} : std::vector{0});
    }
    EXPECT_EQ(caught, 1);
    EXPECT_EQ(trials[2].kind, TrialKind::perturbed);
    EXPECT_EQ(trials[2].share, 0.5);
    EXPECT_EQ(trials[6].share, 1);
    EXPECT_EQ(trials[7].condition, 0);  // sequential
    EXPECT_EQ(trials[8].condition, 1);
    const auto conditions = [&](uint64_t seed) {
        std::string out;
        const session::Plan of_seed = session::make_plan(files.request(seed));
        for (const Trial& t : of_seed.task->trials) out += number_text(t.condition);
        return out;
    };
    EXPECT_EQ(conditions(3), conditions(3));
    std::set<std::string> different;
    for (uint64_t seed = 1; seed < 9; ++seed) different.insert(conditions(seed));
    EXPECT_GT(different.size(), 3u);
}

TEST(Order, IsOfEachParticipantAndTheSameAgain) {
    session::Files files;
    const auto conditions = [&](const char* participant) {
        std::string out;
        const session::Plan plan = session::make_plan(files.request(1, participant));
        for (const Trial& t : plan.task->trials) out += number_text(t.condition);
        return out;
    };
    EXPECT_EQ(conditions("S01"), conditions(""));
    EXPECT_EQ(conditions("S02"), conditions("pilot-02"));
    std::set<std::string> different;
    for (const char* participant : {"S01", "S02", "S03", "S04", "S05", "S06", "S07", "S08"})
        different.insert(conditions(participant));
    EXPECT_GT(different.size(), 3u);
    // in a curve over trials, the kinds of trial are the same for all participants
    const auto kinds = [&](const char* participant) {
        std::vector<TrialKind> out;
        const session::Plan plan = session::make_plan(files.request(1, participant));
        for (const Trial& t : plan.task->trials) out.push_back(t.kind);
        return out;
    };
    EXPECT_EQ(kinds("S01"), kinds("S07"));
}

TEST(Order, ParticipantsNumbersOrderRounds) {
    session::Files files;
    files.replace("  redo: next\n",
                  "  redo: next\n  round_order: latin_square\n"
                  "  rounds: [{ name: a }, { name: b }]\n");
    EXPECT_EQ(session::make_plan(files.request(1, "S01")).task->trials.front().round, 0);
    EXPECT_EQ(session::make_plan(files.request(1, "S02")).task->trials.front().round, 1);
    EXPECT_THROW(session::make_plan(files.request(1, "")), Error);
}

TEST(TrialQueue, DoesTrialsAgainWhereThePolicySays) {
    std::vector<Trial> trials(5);
    for (size_t i = 0; i < 5; ++i) trials[i].number = i < 3 ? 1 : 2;
    const auto done = [&](Redo redo, int bad_attempts) {
        TrialQueue queue(trials, redo, 3, 1);
        std::string out;
        while (!queue.empty()) {
            out += number_text(queue.trial());
            queue.finish(queue.trial() == 0 && queue.attempt() <= bad_attempts);
        }
        return out;
    };
    EXPECT_EQ(done(Redo::never, 9), "01234");
    EXPECT_EQ(done(Redo::next, 1), "001234");
    EXPECT_EQ(done(Redo::end_of_block, 1), "012034");
    EXPECT_EQ(done(Redo::end_of_block, 9), "0120034");  // at most three attempts
    EXPECT_EQ(done(Redo::random, 1).substr(done(Redo::random, 1).size() - 2), "34");
    EXPECT_EQ(done(Redo::random, 1), done(Redo::random, 1));
}

TEST(TrialQueue, GoesThroughWhatWasDoneThoughSomeOfItIsLost) {
    const std::vector<Trial> trials(4);
    TrialQueue queue(trials, Redo::end_of_block, 3, 1);
    const auto made = [&](int trial, int attempt, bool redo) {
        EXPECT_TRUE(queue.go_to(trial, attempt));
        EXPECT_EQ(queue.trial(), trial);
        EXPECT_EQ(queue.attempt(), attempt);
        queue.finish(redo);
    };
    made(0, 1, false);
    made(2, 1, false);  // the end of the second trial is missing
    EXPECT_EQ(queue.trial(), 1);
    made(3, 2, true);  // the first attempt at this trial was interrupted by a pause
    made(3, 3, true);  // the last attempt allowed
    EXPECT_EQ(queue.trial(), 1);
    made(1, 1, false);
    EXPECT_TRUE(queue.empty());
    EXPECT_FALSE(queue.go_to(1, 1));
}

}  // namespace
}  // namespace dihaptic::task::trials_test
