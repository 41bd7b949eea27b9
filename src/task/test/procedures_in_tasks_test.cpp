// Tests procedures in experiment files: the shares must follow from the answers of observers with a
// known psychometric function.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/random.h"
#include "session/test/reaches.h"
#include "task/test/resting_hand.h"
#include "testing/allocation_guard.h"

namespace dihaptic::task::procedures_in_tasks_test {
namespace {

using session::Mistake;

/// A task that asks whether the display is rotated (y or n), with two procedures of different
/// kinds.
const char* const kThresholds = R"(title: Thresholds
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 6 }
  perturbations:
    - name: left
      visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 40 }
    - name: right
      visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: -40 }
  states:
    - name: answer
      exits:
        - { when: key, key: y, outcome: turned }
        - { when: key, key: n, outcome: straight }
        - { when: time, after_s: 5, outcome: late, redo: yes }
      simulated_hand: [{ duration_s: 0.2 }]
  procedures:
    - name: left
      perturb: left
      yes: turned
      no: straight
      guess: 0
      trials: 200
      staircase: { start: 0.8, steps_up: [0.2, 0.1, 0.05, 0.02], reversals: 40, skipped_reversals: 8 }
    - name: right
      perturb: right
      yes: turned
      no: straight
      guess: 0
      trials: 60
      quest_plus:
        levels: { from: 0, to: 1, count: 41 }
        thresholds: { from: 0.1, to: 0.9, count: 33 }
        shapes: { from: 0.05, to: 0.2, count: 4 }
        lapses: { from: 0.02, to: 0.02, count: 1 }
  blocks:
    - { name: thresholds, kind: perturbed, procedures: [left, right], insert: [{ kind: catch, count: 10 }] }
)";

constexpr double kThreshold = 0.4;
constexpr double kSpread = 0.1;

struct Answered {
    std::string procedure;
    double share;
    Attempt attempt;
};

/// Answers the director's questions at once, until the director stops or `most` trials are over.
std::vector<Answered> answer(const session::Plan& plan, const std::vector<Attempt>& done,
                             Random& observer, size_t most = 100000) {
    test::RestingHand hand(plan, done);
    std::vector<Answered> out;
    while (out.size() < most) {
        const frame::Commands& commands = hand.tick();
        if (commands.task.outcome >= 0) {
            const Trial& trial = plan.task->trials[static_cast<size_t>(commands.trial) - 1];
            out.push_back(
                {trial.procedure < 0
                     ? ""
                     : plan.task->task.procedures[static_cast<size_t>(trial.procedure)].name,
                 hand.last.task.share,
                 {commands.trial - 1, commands.task.attempt, commands.task.outcome}});
        } else {
            const double z = (commands.task.share - kThreshold) / kSpread;
            const bool yes = observer.uniform(0, 1) < std::erfc(-z / std::sqrt(2)) / 2;
            hand.director.press(yes ? 'y' : 'n');
        }
        if (commands.stop) break;
    }
    return out;
}

struct Thresholds : session::Files {
    Thresholds() { experiment = kThresholds; }
};

TEST(ProceduresInTasks, FindTheThresholdInMixedTrialsOfNoMoreThanTheyNeed) {
    Thresholds files;
    const session::Plan plan = session::make_plan(files.request());
    EXPECT_EQ(plan.task->trials.size(), 270u);
    Random observer(5, "observer");
    const auto answers = answer(plan, {}, observer);
    std::map<std::string, std::vector<double>> shares;
    for (const Answered& a : answers) shares[a.procedure].push_back(a.share);
    EXPECT_EQ(shares["right"].size(), 60u);
    EXPECT_LT(shares["left"].size(), 200u);  // fewer trials are needed for 40 reversals
    EXPECT_EQ(shares[""], std::vector<double>(10, 0.0));
    for (const char* name : {"left", "right"}) {
        const auto& levels = shares[name];
        double mean = 0;
        for (size_t i = levels.size() / 2; i < levels.size(); ++i)
            mean += levels[i] / static_cast<double>(levels.size() - levels.size() / 2);
        EXPECT_NEAR(mean, kThreshold, 0.06) << name;
        EXPECT_LE(*std::max_element(levels.begin(), levels.end()), 1);
        EXPECT_GE(*std::min_element(levels.begin(), levels.end()), 0);
    }
    // the procedures are mixed, so both occur in the first twenty trials
    int lefts = 0;
    for (size_t i = 0; i < 20; ++i) lefts += answers[i].procedure == "left";
    EXPECT_GT(lefts, 0);
    EXPECT_LT(lefts, 20);
}

TEST(ProceduresInTasks, GoOnWhereASessionWasInterrupted) {
    Thresholds files;
    const session::Plan plan = session::make_plan(files.request());
    Random observer(5, "observer");
    const auto all = answer(plan, {}, observer);
    std::vector<Attempt> done;
    for (size_t i = 0; i < 70; ++i) done.push_back(all[i].attempt);
    Random again(6, "observer");
    const auto rest = answer(plan, done, again, 1);
    ASSERT_EQ(rest.size(), 1u);
    EXPECT_EQ(rest[0].procedure, all[70].procedure);
    EXPECT_EQ(rest[0].share, all[70].share);
}

TEST(ProceduresInTasks, TakeUpAnswersWithoutAllocating) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Thresholds files;
    const session::Plan plan = session::make_plan(files.request());
    test::RestingHand hand(plan);
    const testing::AllocationGuard guard;
    for (int i = 0; !hand.tick().stop; ++i) hand.director.press(i % 3 == 0 ? 'n' : 'y');
    EXPECT_EQ(guard.count(), 0u);
}

class BrokenProcedure : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenProcedure, IsRefusedWithFileLineAndRemedy) {
    Thresholds files;
    session::expect_refused(files, GetParam());
}
INSTANTIATE_TEST_SUITE_P(
    Mistakes, BrokenProcedure,
    ::testing::Values(
        Mistake{"procedures: [left, right]", "procedures: [left, rihgt]", "Did you mean right?"},
        Mistake{"yes: turned\n      no: straight\n      guess: 0\n      trials: 60",
                "yes: turnd\n      no: straight\n      guess: 0\n      trials: 60",
                "Did you mean turned?"},
        Mistake{"no: straight", "no: turned", "same outcome as for 'yes'"},
        Mistake{"no: straight", "no: late", "'late' are repeated"},
        Mistake{"perturb: right", "perturb: wrong", "not a perturbation"},
        Mistake{"steps_up: [0.2, 0.1, 0.05, 0.02]", "steps_up: []", "list of numbers"},
        Mistake{"steps_up: [0.2, 0.1, 0.05, 0.02]", "steps_up: [0.2, -0.1]", "positive"},
        Mistake{"start: 0.8", "start: 1.8", "the limit for levels of a share is 1"},
        Mistake{"levels: { from: 0, to: 1,", "levels: { from: 0, to: 2,",
                "the limit for levels of a share is 1"},
        Mistake{"shapes: { from: 0.05,", "shapes: { from: -1,", "quest_plus.shapes"},
        Mistake{"levels: { from: 0, to: 1, count: 41 }",
                "levels: { from: 0, to: 1, count: 900 }\n        lapse: 3", "lapse"},
        Mistake{"      staircase: { start: 0.8, steps_up: [0.2, 0.1, 0.05, 0.02], "
                "reversals: 40, skipped_reversals: 8 }\n",
                "", "no way to choose levels"},
        Mistake{"      staircase:",
                "      quest: { prior_mean: -0.5, prior_sd: 0.5 }\n      staircase:",
                "more than one way"},
        Mistake{"kind: perturbed, procedures: [left, right]",
                "kind: perturbed, procedures: [left, right], perturb: left",
                "already choose the perturbation"}));

}  // namespace
}  // namespace dihaptic::task::procedures_in_tasks_test
