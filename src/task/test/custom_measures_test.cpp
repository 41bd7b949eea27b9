// Tests the custom measures of a task against the recorded frames, and the error message for every
// mistake.
#include "task/plan/custom_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "analysis/session_report.h"
#include "base/table.h"
#include "recording/raw_log.h"
#include "session/test/reaches.h"

namespace dihaptic::task::custom_measures_test {
namespace {

using session::Mistake;

const char* const kBlocks = "  blocks:\n";

/// Checks the SD, root mean square and median of x in the row [mm].
void expect_spread(const CsvFile& trials, size_t row, std::vector<double> x) {
    const auto count = static_cast<double>(x.size());
    double sum = 0;
    double squares = 0;
    for (const double value : x) sum += value;
    for (const double value : x) squares += value * value;
    EXPECT_NEAR(trials.number(row, "rms_x_mm"), std::sqrt(squares / count), 1e-6);
    EXPECT_NEAR(trials.number(row, "sd_x_mm"),
                std::sqrt((squares - sum * sum / count) / (count - 1)), 1e-6);
    std::sort(x.begin(), x.end());
    const size_t half = x.size() / 2;
    EXPECT_NEAR(trials.number(row, "median_x_mm"),
                x.size() % 2 == 1 ? x[half] : (x[half - 1] + x[half]) / 2, 1e-6);
}

TEST(CustomMeasures, AreTakenOfEachAttemptInItsStates) {
    session::Files files;
    files.replace(
        kBlocks,
        "  draws: [{ name: bonus, uniform: { from: 1, to: 2 } }]\n"
        "  custom_measures:\n"
        "    - { name: top_speed_mm_s, of: index.speed, take: max, during: [reach] }\n"
        "    - { name: way_mm, of: 'distance(index, start) * bonus', take: last }\n"
        "    - { name: waited, of: time_in_state / 1 s, take: last, during: [home] }\n"
        "    - { name: mean_z_m, of: index.z, take: mean }\n"
        "    - { name: sd_x_mm, of: index.x, take: sd }\n"
        "    - { name: held_m_s, of: index.speed, take: max, window_s: 0.05, during: [reach] }\n"
        "    - { name: rms_x_mm, of: index.x, take: rms }\n"
        "    - { name: later_x_mm, of: index.x, take: mean, during: [reach], "
        "when: 50 ms < time_in_state < 100 ms }\n"
        "    - { name: fast_s, of: time_in_state, take: first, during: [reach], "
        "when: index.speed > 100 mm/s }\n"
        "    - { name: never_mm, of: index.x, take: max, when: index.x > 1 m }\n"
        "    - { name: median_x_mm, of: index.x, take: median }\n"
        "  blocks:\n");
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    struct Expected {
        double speed = 0, way = 0, entered = 0, waited = 0, z = 0;
        int phase = 0, ticks = 0;
        std::vector<double> x;       // [mm]
        std::vector<double> speeds;  // speeds during the reach [m/s]
        std::vector<double> later;   // x from 50 to 100 ms after the start of the reach [mm]
        double fast = -1;            // time at which the reach exceeds 0.1 m/s [s]
    };
    std::map<int, Expected> expected;  // by trial
    recording::RawLogReader log(result.folder + "/raw.log");
    while (const frame::Frame* frame = log.next()) {
        if (frame->phase == 0 || frame->task.outcome >= 0) continue;
        Expected& e = expected[frame->trial];
        const Vec3& p_W = frame->fingers[0].p_WH;
        const double now = seconds(frame->time);
        if (frame->phase != e.phase) e.entered = now;
        e.phase = frame->phase;
        if (frame->phase == 1) e.waited = now - e.entered;
        if (frame->phase == 2) e.speed = std::max(e.speed, frame->fingers[0].v_WH.norm());
        e.way = (p_W - Vec3(0, 0, 0.12)).norm() *
                plan.task->trials[static_cast<size_t>(frame->trial - 1)].draws[0];
        e.z += (p_W.z() - e.z) / ++e.ticks;
        e.x.push_back(1e3 * p_W.x());
        if (frame->phase != 2) continue;
        const double speed = frame->fingers[0].v_WH.norm();
        const double time = now - e.entered;
        e.speeds.push_back(speed);
        if (time > 0.05 && time < 0.1) e.later.push_back(1e3 * p_W.x());
        if (speed > 0.1 && e.fast < 0) e.fast = time;
    }
    const CsvFile trials(result.folder + "/trials.csv");
    ASSERT_EQ(trials.rows(), 9u);
    for (size_t i = 0; i < trials.rows(); ++i) {
        const Expected& e = expected.at(static_cast<int>(trials.number(i, "trial_num")));
        EXPECT_GT(e.speed, 0.1);
        EXPECT_NEAR(trials.number(i, "top_speed_mm_s"), 1e3 * e.speed, 1e-6);
        EXPECT_NEAR(trials.number(i, "way_mm"), 1e3 * e.way, 1e-6);
        EXPECT_NEAR(trials.number(i, "waited"), e.waited, 1e-6);
        EXPECT_NEAR(trials.number(i, "mean_z_m"), e.z, 1e-9);
        expect_spread(trials, i, e.x);
        double held = 0;  // the highest mean over 50 ticks
        for (size_t k = 50; k <= e.speeds.size(); ++k) {
            double sum = 0;
            for (size_t j = k - 50; j < k; ++j) sum += e.speeds[j];
            held = std::max(held, sum / 50);
        }
        EXPECT_NEAR(trials.number(i, "held_m_s"), held, 1e-4);
        const double later = std::accumulate(e.later.begin(), e.later.end(), 0.0);
        EXPECT_NEAR(trials.number(i, "later_x_mm"), later / static_cast<double>(e.later.size()),
                    0.5);  // rounding errors in sums of ticks, at both ends
        EXPECT_NEAR(trials.number(i, "fast_s"), e.fast, 1e-6);
        EXPECT_EQ(trials.text(i, "never_mm"), "");
        EXPECT_EQ(trials.text(i, kNotMeasured), "never_mm: not measured");
    }
}

TEST(CustomMeasures, OfWhatIsShownFollowTheDisplayToTheLastTick) {
    session::Files files;
    files.replace(kBlocks,
                  "  variables: [{ name: rule_mm }]\n"
                  "  after_trial: [{ set: rule_mm, to: index.shown.y }]\n"
                  "  custom_measures:\n"
                  "    - { name: shown_mm, of: index.shown.y, take: last, during: [reach] }\n"
                  "    - { name: hand_mm, of: index.y, take: last, during: [reach] }\n"
                  "  blocks:\n");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    const CsvFile trials(result.folder + "/trials.csv");
    double aside = 0;
    for (size_t i = 0; i < trials.rows(); ++i) {
        const double shown = trials.number(i, "shown_mm");
        // the rule uses the position of the hand one tick later, which during a reach is up to half
        // a millimetre further on
        EXPECT_NEAR(shown, trials.number(i, next_column("rule_mm")), 0.5);
        aside = std::max(aside, std::abs(shown - trials.number(i, "hand_mm")));
    }
    EXPECT_GT(aside, 20);  // due to the rotation by 30 degrees, at 45 mm
}

TEST(CustomMeasures, AreKnownToRulesWhichLookBackOverTrials) {
    session::Files files;
    files.replace(
        kBlocks,
        "  variables:\n"
        "    [{ name: top_mm_s }, { name: mean_mm_s }, { name: middle_mm_s }, { name: sd_mm_s },\n"
        "     { name: best_mm_s }, { name: ahead }]\n"
        "  custom_measures: [{ name: speed_mm_s, of: index.speed, take: max, during: [reach] }]\n"
        "  after_trial:\n"
        "    - { set: top_mm_s, to: measure.speed }\n"
        "    - { set: mean_mm_s, to: 'mean(measure.speed, 3)' }\n"
        "    - { set: middle_mm_s, to: 'median(measure.speed, 4)' }\n"
        "    - { set: sd_mm_s, to: 'sd(measure.speed, 3)' }\n"
        "    - { set: best_mm_s, to: best(measure.speed) }\n"
        "    - { when: 'measure.speed > median(measure.speed, 4)', set: ahead, to: ahead + 1 }\n"
        "  blocks:\n");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    const CsvFile trials(result.folder + "/trials.csv");
    ASSERT_EQ(trials.rows(), 9u);
    const auto after = [&](size_t i, const char* name) {
        return trials.number(i, next_column(name));
    };
    std::vector<double> tops;
    int ahead = 0;
    int ties = 0;
    for (size_t i = 0; i < trials.rows(); ++i) {
        EXPECT_NEAR(after(i, "top_mm_s"), trials.number(i, "speed_mm_s"), 1);
        tops.push_back(after(i, "top_mm_s"));
        const auto last = [&](size_t count) {
            return std::vector<double>(tops.end() - static_cast<long>(std::min(count, tops.size())),
                                       tops.end());
        };
        std::vector<double> x = last(3);
        double mean = 0;
        for (const double value : x) mean += value / static_cast<double>(x.size());
        double squares = 0;
        for (const double value : x) squares += std::pow(value - mean, 2);
        EXPECT_NEAR(after(i, "mean_mm_s"), mean, 1e-5);
        if (x.size() > 1) {
            EXPECT_NEAR(after(i, "sd_mm_s"),
                        std::sqrt(squares / (static_cast<double>(x.size()) - 1)), 1e-4);
        }
        std::vector<double> four = last(4);
        std::sort(four.begin(), four.end());
        const size_t half = four.size() / 2;
        const double middle = four.size() % 2 == 1 ? four[half] : (four[half - 1] + four[half]) / 2;
        EXPECT_NEAR(after(i, "middle_mm_s"), middle, 1e-5);
        EXPECT_NEAR(after(i, "best_mm_s"), *std::max_element(tops.begin(), tops.end()), 1e-5);
        ahead += tops.back() > middle ? 1 : 0;
        // the tables store nine digits, and some of the script's reaches are the same
        ties += std::abs(tops.back() - middle) < 1e-5 ? 1 : 0;
        EXPECT_NEAR(after(i, "ahead"), ahead, ties);
    }
    EXPECT_LT(ties, 7);
}

TEST(CustomMeasures, MayAskForTheRoundAndItsFactors) {
    session::Files files;
    files.keep_first_block();
    files.replace(kBlocks,
                  "  rounds:\n"
                  "    - { name: by hand, factors: { gain: 1, by: hand } }\n"
                  "    - { name: by knob, factors: { gain: 2, by: knob } }\n"
                  "  custom_measures:\n"
                  "    - { name: knob, of: '1 if round == \"by knob\" else 0', take: last }\n"
                  "    - { name: same, of: '1 if by == \"knob\" else 0', take: last }\n"
                  "    - { name: doubled, of: 2 * gain, take: last }\n"
                  "  blocks:\n");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    const CsvFile trials(result.folder + "/trials.csv");
    ASSERT_EQ(trials.rows(), 4u);
    for (size_t i = 0; i < trials.rows(); ++i) {
        const bool knob = trials.text(i, "round") == "by knob";
        EXPECT_EQ(trials.text(i, "by"), knob ? "knob" : "hand");
        EXPECT_EQ(trials.number(i, "gain"), knob ? 2 : 1);
        EXPECT_EQ(trials.number(i, "knob"), knob ? 1 : 0);
        EXPECT_EQ(trials.number(i, "same"), knob ? 1 : 0);
        EXPECT_EQ(trials.number(i, "doubled"), knob ? 4 : 2);
    }
}

TEST(CustomMeasures, AreTakenInBlocksBesideTheRoundsToo) {
    session::Files files;
    files.keep_first_block();
    files.replace(
        kBlocks,
        "  rounds: [{ name: first, factors: { gain: 1 } }, { name: last, factors: { gain: 2 } }]\n"
        "  custom_measures:\n"
        "    - { name: last, of: '1 if round == \"last\" else 0', take: last }\n"
        "    - { name: beside, of: '1 if round == \"\" else 0', take: last }\n"
        "  blocks:\n"
        "    - { name: thanks, once: after, conditions: [far], repeats: 1 }\n"
        "    - { name: practice, once: before, conditions: [far], repeats: 1 }\n");
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    const CsvFile trials(result.folder + "/trials.csv");
    std::string blocks;
    for (size_t i = 0; i < trials.rows(); ++i) {
        const std::string round = trials.text(i, "round");
        blocks += trials.text(i, "block") + "/" + round + " ";
        EXPECT_EQ(trials.text(i, "gain").empty(), round.empty());
        EXPECT_EQ(trials.number(i, "last"), round == "last" ? 1 : 0);
        EXPECT_EQ(trials.number(i, "beside"), round.empty() ? 1 : 0);
    }
    EXPECT_EQ(blocks, "practice/ before/first before/first before/last before/last thanks/ ");
    const std::vector<Trial> again =
        read_trial_list(plan.task->task, result.folder + "/trial-list.csv");
    ASSERT_EQ(again.size(), trials.rows());
    for (size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i].round, plan.task->trials[i].round);
}

TEST(CustomMeasures, SayWhatTheyCouldNotTake) {
    session::Files files;
    files.replace("        - { when: outside, region: shell, outcome: reached",
                  "        - { when: key, key: x, to: never }\n"
                  "        - { when: outside, region: shell, outcome: reached");
    files.replace("  reach: {",
                  "    - { name: never, exits: [{ when: time, after_s: 1, outcome: late }] }\n"
                  "  custom_measures: [{ name: z_mm, of: index.z, take: min, during: [never] }]\n"
                  "  reach: {");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    const CsvFile trials(result.folder + "/trials.csv");
    EXPECT_EQ(trials.text(0, "z_mm"), "");
    EXPECT_EQ(trials.text(0, kNotMeasured), "z_mm: not measured");
}

class MistakenMeasure : public ::testing::TestWithParam<Mistake> {};

TEST_P(MistakenMeasure, IsRefusedWithFileLineAndRemedy) {
    session::Files files;
    const Mistake& mistake = GetParam();
    const std::string by = std::string("  custom_measures: [") + mistake.by + "]\n  blocks:\n";
    session::expect_refused(files, {mistake.what, by.c_str(), mistake.said});
}

INSTANTIATE_TEST_SUITE_P(
    CustomMeasures, MistakenMeasure,
    ::testing::Values(
        Mistake{kBlocks, "{ name: a_N, of: grip_forc, take: max }", "Did you mean grip_force?"},
        Mistake{kBlocks, "{ name: a_N, of: index.speed, take: max }", "but must be a"},
        Mistake{kBlocks, "{ name: a, of: index.speed, take: max }", "but must be a"},
        Mistake{kBlocks, "{ name: a_m_s, of: index.speed > 1 m_s, take: max }",
                "must be a number, or a formula with a number"},
        Mistake{kBlocks, "{ name: a_m_s, of: index.speed, take: most }", "'most' is not known"},
        Mistake{kBlocks, "{ name: a_m_s, of: index.speed }", "take: is missing"},
        Mistake{kBlocks, "{ name: a_m_s, take: max }", "of: is missing"},
        Mistake{kBlocks, "{ of: index.speed, take: max }", "name: is missing"},
        Mistake{kBlocks, "{ name: a, of: 1, take: max, when: 2 + 3 }", "is not a condition"},
        Mistake{kBlocks, "{ name: a, of: 1, take: max, when: time_in_stat > 1 s }",
                "Did you mean time_in_state?"},
        Mistake{kBlocks, "{ name: a b, of: 1, take: max }", "cannot be the name of a column"},
        Mistake{kBlocks, "{ name: outcome, of: 1, take: max }", "is the name of another column"},
        Mistake{kBlocks, "{ name: a, of: 1, take: max }, { name: a, of: 2, take: max }",
                "there are two measures 'a'"},
        Mistake{kBlocks, "{ name: a, of: 1, take: max, during: [raech] }", "Did you mean reach?"},
        Mistake{kBlocks, "{ name: a, of: 'mean(trial_num, 3)', take: max }",
                "'mean' looks back over trials. In after_trial, set a variable to it"}));

/// A mistake in a measure that a rule may use, or in the rule itself.
class MistakenRule : public ::testing::TestWithParam<Mistake> {};

TEST_P(MistakenRule, IsRefused) {
    session::Files files;
    const Mistake& mistake = GetParam();
    const std::string by = std::string(
                               "  variables: [{ name: v_mm }]\n"
                               "  custom_measures: [{ name: x_mm, of: index.x, take: ") +
                           mistake.what + " }]\n  after_trial: [{ set: v_mm, to: '" + mistake.by +
                           "' }]\n  blocks:\n";
    session::expect_refused(files, {kBlocks, by.c_str(), mistake.said});
}

INSTANTIATE_TEST_SUITE_P(
    CustomMeasures, MistakenRule,
    ::testing::Values(Mistake{"median", "measure.x", "its value only after the session"},
                      Mistake{"last }, { name: x_rad, of: 1, take: last", "1 mm * measure.x",
                              "'x_mm' and 'x_rad' are both measure.x in after_trial"},
                      Mistake{"last", "measure.y", "'measure.y' is not a quantity"},
                      Mistake{"last", "mean(measure.x)", "the number of trials is missing"},
                      Mistake{"last", "mean(measure.x, 0)", "a whole number from 1 to 1000"},
                      Mistake{"last", "mean(measure.x, 2.5)", "a whole number from 1 to 1000"},
                      Mistake{"last", "mean(measure.x > 1 mm, 3)", "but must be a number"}));

}  // namespace
}  // namespace dihaptic::task::custom_measures_test
