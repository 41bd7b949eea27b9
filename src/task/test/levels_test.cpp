// Tests numbers that procedures choose for use in formulas, in two intervals whose order is random.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "analysis/recovery.h"
#include "analysis/thresholds.h"
#include "base/text_file.h"
#include "session/replay.h"
#include "task/test/observer.h"
#include "testing/allocation_guard.h"

namespace dihaptic::task::levels_test {
namespace {

using session::Mistake;
using test::Intervals;
using test::IntervalTrial;

const char* const kConstant =
    "trials: 60\n      constant: { levels: [0.1, 0.2, 0.3, 0.4, 0.5, 0.6] }";
const char* const kStaircase =
    "trials: 60\n      staircase: { start: 0.8, lowest: 0, highest: 1, steps_up: [0.2, 0.1, 0.05], "
    "down_after: 2, down_over_up: 0.5488 }";
const char* const kQuest =
    "trials: 60\n      logarithmic: yes\n      sigmoid: weibull_log10\n      quest: { prior_mean: "
    "-0.5, prior_sd: 0.5, lowest: -2, highest: 0 }";
const char* const kQuestPlus =
    "trials: 60\n      quest_plus: { levels: { from: 0.02, to: 1, count: 50 }, thresholds: { from: "
    "0.05, to: 0.9, count: 35 }, shapes: { from: 0.1, to: 0.1, count: 1 } }";

const model::Psychometric kObserver{
    .sigmoid = model::Sigmoid::normal, .threshold = 0.35, .shape = 0.1, .guess = 0.5, .lapse = 0};

std::vector<IntervalTrial> trials_of(const char* procedure, uint64_t seed) {
    Intervals files(procedure);
    const session::Plan plan = session::make_plan(files.request(seed));
    Random random(seed, "observer");
    return test::observe(plan, kObserver, random);
}

TEST(Levels, AreWhatFormulasGiveInTheIntervalThatIsDrawn) {
    for (const char* procedure : {kConstant, kStaircase, kQuest, kQuestPlus}) {
        const auto trials = trials_of(procedure, 3);
        ASSERT_EQ(trials.size(), 60u) << procedure;
        std::set<double> levels;
        for (const IntervalTrial& trial : trials) {
            EXPECT_NEAR(trial.comparison, 1 + trial.level, 1e-12) << procedure;
            EXPECT_EQ(trial.standard, 1) << procedure;
            EXPECT_TRUE(trial.outcome == "comparison" || trial.outcome == "standard");
            levels.insert(trial.level);
        }
        EXPECT_GT(levels.size(), 4u) << procedure;
    }
}

TEST(Levels, OfConstantStimuliComeEquallyOftenInAnOrderOfTheSeed) {
    const auto a = trials_of(kConstant, 1);
    const auto b = trials_of(kConstant, 2);
    std::map<double, int> count;
    bool same = true;
    for (size_t i = 0; i < a.size(); ++i) {
        ++count[a[i].level];
        same = same && a[i].level == b[i].level;
    }
    EXPECT_FALSE(same);
    EXPECT_EQ(count.size(), 6u);
    for (const auto& [level, times] : count) EXPECT_EQ(times, 10) << level;
    // every round contains each level once
    for (size_t round = 0; round < 10; ++round) {
        std::set<double> levels;
        for (size_t i = 0; i < 6; ++i) levels.insert(a[6 * round + i].level);
        EXPECT_EQ(levels.size(), 6u);
    }
}

TEST(Levels, OrderOfIntervalsIsDrawnFromTheSeedAndFrozen) {
    Intervals files(kConstant);
    const session::Plan plan = session::make_plan(files.request(5));
    const Table list = trial_list(plan.task->task, plan.task->trials);
    const auto column = static_cast<size_t>(
        std::find_if(list.columns.begin(), list.columns.end(),
                     [](const Table::Column& c) { return c.name == "comparison_interval"; }) -
        list.columns.begin());
    ASSERT_LT(column, list.columns.size());
    int first = 0;
    for (const auto& row : list.rows) {
        const double interval = std::get<double>(row[column]);
        EXPECT_TRUE(interval == 1 || interval == 2);
        first += interval == 1;
    }
    EXPECT_GT(first, 15);
    EXPECT_LT(first, 45);
    const session::Plan again = session::make_plan(files.request(5));
    for (size_t i = 0; i < plan.task->trials.size(); ++i)
        EXPECT_EQ(plan.task->trials[i].draws, again.task->trials[i].draws);
}

TEST(Levels, ThatAdaptSettleAtTheThreshold) {
    struct Case {
        const char* procedure;
        double wanted;  // level at which the procedure settles, given its share of right answers
    };
    // the levels satisfy Phi((x - 0.35) / 0.1) = 2 (p - 0.5), with p = 80.35 %, 82 %, and about 83
    // %
    for (const Case& c : {Case{kStaircase, 0.377}, Case{kQuest, 0.386}, Case{kQuestPlus, 0.39}}) {
        double mean = 0;
        constexpr int kRuns = 10;
        for (int run = 0; run < kRuns; ++run) {
            const auto trials = trials_of(c.procedure, static_cast<uint64_t>(100 + run));
            for (size_t i = 30; i < trials.size(); ++i) mean += trials[i].level / 30 / kRuns;
        }
        EXPECT_NEAR(mean, c.wanted, 0.08) << c.procedure;
    }
}

TEST(Levels, GoOnWhereASessionWasInterrupted) {
    for (const char* procedure : {kConstant, kStaircase, kQuestPlus}) {
        Intervals files(procedure);
        const session::Plan plan = session::make_plan(files.request());
        Random random(5, "observer");
        const auto all = test::observe(plan, kObserver, random);
        std::vector<Attempt> done;
        for (size_t i = 0; i < 25; ++i) done.push_back(all[i].attempt);
        Random again(6, "observer");
        const auto rest = test::observe(plan, kObserver, again, done, 1);
        ASSERT_EQ(rest.size(), 1u);
        EXPECT_EQ(rest[0].level, all[25].level);
        EXPECT_EQ(rest[0].comparison, all[25].comparison);
    }
}

TEST(Levels, StandInTheTablesAndTheFit) {
    Intervals files("trials: 12\n      constant: { levels: [0.1, 0.3, 0.5] }");
    files.replace("after_s: 5, outcome: late, redo: yes", "after_s: 0.05, outcome: late");
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    const CsvFile trials(result.folder + "/trials.csv");
    const CsvFile list(result.folder + "/trial-list.csv");
    ASSERT_GT(trials.rows(), 0u);
    ASSERT_LE(trials.rows(), list.rows());
    EXPECT_FALSE(trials.has("next_more"));
    for (size_t i = 0; i < trials.rows(); ++i) {
        const double level = trials.number(i, "more");
        EXPECT_TRUE(level == 0.1 || level == 0.3 || level == 0.5) << level;
        EXPECT_EQ(trials.number(i, "share"), 1);
        EXPECT_EQ(trials.text(i, "comparison_interval"), list.text(i, "comparison_interval"));
    }
    const auto tracks = analysis::threshold_tracks(
        rows::TrialFile(trials), rows::ProcedureFile(result.folder + "/procedures.csv"));
    ASSERT_EQ(tracks.size(), 1u);
    EXPECT_EQ(tracks[0].kind, "constant");
    EXPECT_EQ(tracks[0].what(), "more");
    EXPECT_EQ(tracks[0].model.guess, 0.5);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

TEST(Levels, AreStandardWhereNoProcedureChoosesThem) {
    Intervals files(kConstant);
    files.replace("standard: 0", "standard: 0.25");
    files.replace("procedures: [rougher] }",
                  "procedures: [rougher] }\n    - { name: after, kind: perturbed, perturb: felt }");
    const session::Plan plan = session::make_plan(files.request());
    Random random(1, "observer");
    const auto trials = test::observe(plan, kObserver, random);
    ASSERT_EQ(trials.size(), 61u);
    EXPECT_EQ(trials.back().level, 0.25);
    for (const IntervalTrial& trial : trials) EXPECT_EQ(trial.standard, 1.25);
    EXPECT_EQ(trials.back().comparison, 1.25);
}

TEST(Levels, CountInTheUnitOfTheirName) {
    Intervals files("trials: 6\n      constant: { levels: [110, 120, 130] }");
    files.replace("level: more", "level: mass_g");
    files.replace("standard: 0", "standard: 100");
    files.replace("friction_scale: 1 + more", "friction_scale: mass / 100 g");
    const session::Plan plan = session::make_plan(files.request());
    Random random(1, "observer");
    for (const IntervalTrial& trial : test::observe(plan, kObserver, random)) {
        EXPECT_NEAR(trial.comparison, trial.level / 0.1, 1e-12);
        EXPECT_NEAR(trial.standard, 1, 1e-12);
        EXPECT_GE(trial.level, 0.11 - 1e-12);
    }
}

TEST(Levels, AreAsTheDocumentHasThem) {
    const std::string pages = read_text_file("docs/files/procedures.md");
    const size_t begin = pages.find("title: How much rougher");
    ASSERT_NE(begin, std::string::npos);
    std::string example = pages.substr(begin, pages.find("```", begin) - begin);
    const std::string scenes = "../scenes/";
    example.replace(example.find(scenes), scenes.size(),
                    std::filesystem::absolute("scenes").string() + "/");
    testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    session::check_file(folder.write("experiment.yaml", example), diagnostics);
    for (const Problem& p : diagnostics.problems())
        EXPECT_NE(p.severity, Severity::error) << p.text();
}

TEST(Levels, AreChosenWithoutAllocating) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Intervals files(kQuestPlus);
    const session::Plan plan = session::make_plan(files.request());
    test::RestingHand hand(plan);
    const testing::AllocationGuard guard;
    for (int i = 0; !hand.commands.stop && i < 10000; ++i) {
        if (hand.tick().phase == 4) hand.director.press(i % 3 == 0 ? '1' : '2');
    }
    EXPECT_TRUE(hand.commands.stop);
    EXPECT_EQ(guard.count(), 0u);
}

TEST(Levels, AreWhereABodyIsPutInEachInterval) {
    Intervals files(kConstant);
    files.replace(
        "  perturbations:\n    - name: felt\n      body: { body: block, friction_scale: 1 + more "
        "}\n",
        "");
    files.replace("      perturb: felt\n", "");
    files.replace("{ name: first, ",
                  "{ name: first, place: [{ body: table, position_mm: [100 * more, 0, -25] }], ");
    files.replace("{ name: second, ",
                  "{ name: second, place: [{ body: table, position_mm: [100 * more, 0, -25] }], ");
    files.replace("kind: perturbed, ", "kind: baseline, ");
    const session::Plan plan = session::make_plan(files.request());
    test::RestingHand hand(plan);
    std::map<int, double> x;  // by phase
    int trials = 0;
    for (int i = 0; !hand.commands.stop && i < 10000; ++i) {
        const frame::TaskFrame& task = hand.tick().task;
        for (const frame::PlacementFrame& placed : task.placements) {
            hand.last.bodies[static_cast<size_t>(placed.body)].X_WB = placed.X_WB;
            if (placed.body == 0) x[hand.commands.phase] = placed.X_WB.p.x();
        }
        if (hand.commands.phase == 4) hand.director.press('1');
        if (task.outcome < 0) continue;
        const Trial& trial = plan.task->trials[static_cast<size_t>(hand.commands.trial) - 1];
        const bool first = plan.task->interval_of(trial) == 1;
        const double more = task.variables.back().value;
        EXPECT_NEAR(x[1], first ? 0.1 * more : 0, 1e-12) << trials;
        EXPECT_NEAR(x[3], first ? 0 : 0.1 * more, 1e-12) << trials;
        x.clear();
        ++trials;
    }
    EXPECT_EQ(trials, 60);
}

/// The same task with loads instead of a factor on the friction.
struct Loads : Intervals {
    explicit Loads(const std::string& stiffness) : Intervals(kConstant) {
        replace("body: { body: block, friction_scale: 1 + more }",
                "loads:\n        - { kind: spring, on: index, about: here, damping_Ns_m: 2 * more, "
                "delay_ms: 10 * more, stiffness_N_m: " +
                    stiffness +
                    " }\n        - { kind: constant, on: index, force_N: [0, 0, -2 * more] }");
        replace("  perturbations:",
                "  regions: [{ name: here, position_mm: [0, 0, 120] }]\n  perturbations:");
    }
};

TEST(Levels, AreNumbersOfLoads) {
    Loads files("100 * (1 + more)");
    const session::Plan plan = session::make_plan(files.request());
    EXPECT_GE(plan.task->longest_delay, 0.006);
    TrialNumbers numbers(*plan.task);
    auto variables = plan.task->start;
    variables[0].value = 0.5;
    numbers.begin(0, 1, variables);
    const TaskPlan::Cell& cell = numbers.cell();
    const auto loads = cell.perturbations[0].loads();
    ASSERT_EQ(loads.size(), 2u);
    EXPECT_NEAR(loads[0].stiffness(), 150, 1e-9);
    EXPECT_NEAR(loads[0].delay(), 0.005, 1e-12);
    const Motion motion{{0.01, 0, 0.12}, {1, 0, 0}};
    EXPECT_NEAR(loads[0].act(1, cell.p_W, motion).force.x(), -1.5 - 1, 1e-9);
    EXPECT_NEAR(loads[1].act(1, cell.p_W, motion).force.z(), -1, 1e-12);
    // the number has its standard value in the interval without the comparison
    const int interval = plan.task->interval_of(plan.task->trials[0]);
    numbers.follow(1, 1, variables, interval == 1 ? 2 : 0);
    EXPECT_NEAR(numbers.cell().perturbations[0].loads()[0].stiffness(), 100, 1e-9);
    numbers.follow(1, 1, variables, interval == 1 ? 0 : 2);
    EXPECT_NEAR(numbers.cell().perturbations[0].loads()[0].stiffness(), 150, 1e-9);
}

TEST(Levels, ThatMakeALoadImpossibleAreRefused) {
    Loads negative("100 * (0.5 - more)");
    session::expect_refused(negative, {"10 * more", "10 * more", "is negative in a trial"});
    Loads high("1e6 * more");
    session::expect_refused(high, {"10 * more", "10 * more", "gives 600000"});
    Loads late("100");
    session::expect_refused(late, {"10 * more", "1e5 * more", "gives 10000 in trial"});
}

class BrokenLevel : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenLevel, IsRefusedWithFileLineAndRemedy) {
    Intervals files(kStaircase);
    session::expect_refused(files, GetParam());
}
INSTANTIATE_TEST_SUITE_P(
    Mistakes, BrokenLevel,
    ::testing::Values(
        Mistake{"lowest: 0, ", "", "is missing as a limit of more"},
        Mistake{"highest: 1, ", "", "is missing as a limit of more"},
        Mistake{"standard: 0\n", "sigmoid: logistic\n",
                "the value of more where no procedure chooses it"},
        Mistake{"standard: 0\n", "standard: none\n", "standard"},
        Mistake{"level: more\n      perturb: felt\n", "perturb: felt\n",
                "is only for a procedure with 'level'"},
        Mistake{"level: more\n      perturb: felt\n      standard: 0\n", "sigmoid: normal\n",
                "perturb: is missing, and so is 'level'"},
        Mistake{"level: more", "level: block", "is already the quantity block"},
        Mistake{"level: more", "level: 3 more", "cannot be used in a formula"},
        Mistake{"1 + more", "1 + mor", "Did you mean more?"},
        Mistake{"1 + more", "1.5", "no formula uses more"},
        Mistake{"1 + more", "1 + 30 * more", "gives 31"},
        Mistake{"  states:", "  after_trial: [{ set: more, to: 2 }]\n  states:", "not a variable"},
        Mistake{"design: 2afc", "design: 3afc", "design"},
        Mistake{"design: 2afc", "design: 2afc\n      guess: 0.3", "The design determines it"},
        Mistake{"design: 2afc", "design: yes_no\n      guess_is_lapse: yes",
                "The design determines it"},
        Mistake{"interval: 2,", "", "no state has interval 2"},
        Mistake{"interval: 2,", "interval: 3,", "interval"},
        Mistake{"chooses: 2", "chooses: 3", "chooses"},
        Mistake{"chooses: 2", "chooses: 2, outcome: late", "has more than one destination"},
        Mistake{", chooses: 2", "", "leads nowhere"},
        Mistake{"perturb: felt", "perturb: flet", "Did you mean felt?"},
        Mistake{"  states:", "  draws: [{ name: comparison_interval, choice: [1, 3] }]\n  states:",
                "is reserved for the comparison interval"},
        Mistake{"trials: 60", "trials: 60\n      yes: better", "not an outcome"},
        Mistake{"trials: 60", "trials: 60\n      constant: { levels: [1, 1] }",
                "more than one way"}));

TEST(BrokenConstant, IsRefusedWithFileLineAndRemedy) {
    for (const Mistake& mistake :
         {Mistake{"[0.1, 0.2, 0.3,", "[0.1, 0.1, 0.3,", "not a list of different numbers"},
          Mistake{"levels: [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]", "levels: []", "levels"},
          Mistake{"levels: [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]", "levels: [few]", "levels"},
          Mistake{"0.5, 0.6]", "0.5, 0.6], repeats: 3", "repeats"}}) {
        Intervals files(kConstant);
        session::expect_refused(files, mistake);
    }
    Intervals none(kConstant);
    none.replace("interval: 1, ", "");
    session::expect_refused(none,
                            {"interval: 2, ", "", "no state has an interval that can be chosen"});
}

}  // namespace
}  // namespace dihaptic::task::levels_test
