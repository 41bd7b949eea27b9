// Tests draws, factors, variables and formulas in tasks: how they affect trials, their values in
// tables, sessions that are resumed or recovered, and the error message for every mistake.
#include <gtest/gtest.h>

#include <map>

#include "analysis/recovery.h"
#include "base/field_writer.h"
#include "base/number.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/allocations.h"
#include "session/test/reaches.h"

namespace dihaptic::task::formulas_test {
namespace {

namespace fs = std::filesystem;
using session::Mistake;

/// Waits with random durations, followed by reaches to a target that moves further away as the
/// score grows.
const char* const kFormulas = R"(title: Formulas
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  draws:
    - { name: wait_s, exponential: { mean: 0.1, from: 0.1, to: 0.3 } }
    - { name: side, choice: [-1, 1] }
    - { name: which, permutation: [near, far] }
  variables:
    - { name: score }
    - { name: reach_mm, start: 40 }
  after_trial:
    - { when: 'outcome == "reached"', set: score, to: score + 10 }
    - { when: score >= 20, set: reach_mm, to: reach + 5 mm }
  cross:
    - { factor: mass_g, levels: [100, 200] }
    - { factor: surface, levels: [suede, silk] }
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 6 }
    - { name: target, position_mm: [side * reach, start.y, 120], radius_mm: '6 if which == "near" else 8' }
  perturbations:
    - name: changed
      body: { body: block, density_scale: mass / 100 g, friction_scale: '0.5 if surface == "silk" else 1' }
  states:
    - name: home
      perturbed: no
      exits: [{ when: time, after_s: wait, to: reach }]
      simulated_hand: [{ duration_s: 0.05, reach: start }]
    - name: reach
      show: [target]
      exits:
        - { when: inside, region: target, outcome: reached }
        - { when: time, after_s: 1, outcome: too slow }
      simulated_hand: [{ duration_s: 0.1, reach: target }]
  blocks:
    - { name: first, repeats: 2, until: score >= 60 }
    - { name: second, kind: perturbed, perturb: changed }
)";

struct Formulas : session::Files {
    Formulas() { experiment = kFormulas; }
};

std::vector<std::string> column(const std::string& session, const std::string& name) {
    const CsvFile trials(session + "/trials.csv");
    std::vector<std::string> out;
    for (size_t i = 0; i < trials.rows(); ++i) out.push_back(trials.text(i, name));
    return out;
}

std::vector<double> numbers_of(const std::string& session, const std::string& name) {
    std::vector<double> out;
    for (const std::string& text : column(session, name))
        out.push_back(finite_number(text).value());
    return out;
}

void finish(const session::RunResult& result) {
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
}

TEST(Formulas, OfTheSimulatedHandsStepsAreResolvedInEachTrial) {
    Formulas files;
    files.replace(
        "[{ duration_s: 0.1, reach: target }]",
        "[{ duration_s: wait, move_mm: [side * reach, 0, 10], aperture_mm: 20 + wait / 1 s }]");
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    finish(result);
    const CsvFile trials(result.folder + "/trials.csv");
    std::map<int, size_t> rows;
    for (size_t i = 0; i < trials.rows(); ++i)
        rows[static_cast<int>(trials.number(i, "trial_num"))] = i;
    recording::RawLogReader log(result.folder + "/raw.log");
    std::map<int, std::pair<double, Vec3>> began, last;
    while (const frame::Frame* frame = log.next()) {
        if (frame->trial < 1 || frame->phase != 2) continue;
        const std::pair now{seconds(frame->time), frame->fingers[0].p_WH};
        began.try_emplace(frame->trial, now);
        last[frame->trial] = now;
    }
    ASSERT_GE(began.size(), 5u);
    for (const auto& [trial, row] : rows) {
        const Vec3 way = last.at(trial).second - began.at(trial).second;
        const double reach = trials.number(row, "side") * trials.number(row, "reach_mm") * 1e-3;
        // the trial ends when the hand enters the target, before the end of the reaching step, and
        // the hand may still be returning home when the trial begins
        EXPECT_GT(way.x() / reach, 0.5) << trial;
        EXPECT_LT(way.x() / reach, 1.2) << trial;
        EXPECT_NEAR(way.z() / way.x(), 0.01 / reach, 0.3 * std::abs(0.01 / reach)) << trial;
    }
}

TEST(Formulas, FollowDrawsFactorsAndVariablesInEachTrial) {
    Formulas files;
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    finish(result);
    // the first block ends when the score reaches 60
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(10, "reached"));
    EXPECT_EQ(column(result.folder, "trial_num"),
              (std::vector<std::string>{"1", "2", "3", "4", "5", "6", "9", "10", "11", "12"}));
    const auto score = numbers_of(result.folder, "score");
    const auto next = numbers_of(result.folder, "next_score");
    const auto reach = numbers_of(result.folder, "reach_mm");
    for (size_t i = 0; i < 10; ++i) {
        EXPECT_EQ(score[i], 10.0 * static_cast<double>(i));
        EXPECT_EQ(next[i], score[i] + 10);
        EXPECT_EQ(reach[i], i < 2 ? 40 : 40 + 5 * static_cast<double>(i - 1));
    }
    const CsvFile trials(result.folder + "/trials.csv");
    std::map<std::string, size_t> rows;
    for (size_t i = 0; i < trials.rows(); ++i) rows[trials.text(i, "trial_num")] = i;

    recording::RawLogReader log(result.folder + "/raw.log");
    std::map<int, double> began;
    int shown = 0;
    int changed = 0;
    while (const frame::Frame* frame = log.next()) {
        if (frame->trial < 1 || frame->phase == kBetween) continue;
        const size_t row = rows.at(number_text(frame->trial));
        began.try_emplace(frame->trial, seconds(frame->time));
        const double in_trial = seconds(frame->time) - began[frame->trial];
        EXPECT_EQ(frame->phase == 1, in_trial < trials.number(row, "wait_s") - 5e-4);
        for (const frame::TargetFrame& target : frame->task.targets) {
            const double side = trials.number(row, "side");
            EXPECT_NEAR(target.p_WT.x(), side * reach[row] * 1e-3, 1e-12);
            EXPECT_EQ(target.radius, trials.text(row, "which") == "near" ? 0.006 : 0.008);
            ++shown;
        }
        for (const frame::PropertiesFrame& block : frame->task.properties) {
            EXPECT_EQ(block.turning_scale, trials.number(row, "mass_g") / 100);
            EXPECT_EQ(block.friction_scale, trials.text(row, "surface") == "silk" ? 0.5 : 1);
            ++changed;
        }
    }
    EXPECT_GT(shown, 500);
    EXPECT_GT(changed, 200);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

TEST(Formulas, CrossedFactorsMakeTheConditionsAndStandInTheTables) {
    Formulas files;
    files.replace("  blocks:\n",
                  "  conditions: [{ name: 200 silk, places: [{ body: block, position_mm: [60, 0, "
                  "mass / 10 g] }] }]\n  blocks:\n");
    const session::Plan plan = session::make_plan(files.request());
    const auto& conditions = plan.task->task.conditions;
    ASSERT_EQ(conditions.size(), 4u);
    EXPECT_EQ(conditions[0].name, "100 suede");
    EXPECT_EQ(conditions[3].name, "200 silk");
    EXPECT_EQ(conditions[3].places.size(), 1u);
    TrialNumbers numbers(*plan.task);
    const Table list = frozen_list(*plan.task, plan.scene);
    std::vector<std::string> names;
    for (const Table::Column& c : list.columns) names.push_back(c.name);
    const size_t own = kTrialListColumns.size();
    EXPECT_EQ(std::vector<std::string>(names.begin() + static_cast<long>(own), names.end()),
              (std::vector<std::string>{"mass_g", "surface", "wait_s", "side", "which"}));
    for (size_t i = 0; i < list.rows.size(); ++i) {
        const auto text = [&](size_t k) { return to_csv(list.rows[i][own + k]); };
        EXPECT_EQ(to_csv(list.rows[i][6]), text(0) + " " + text(1));
        numbers.begin(static_cast<int>(i), 1, plan.task->start);
        const bool heavy_silk = text(0) == "200" && text(1) == "silk";
        const Vec3 p_W = heavy_silk ? Vec3(0.06, 0, 0.02) : Vec3(0, 0, 0.02);
        EXPECT_LT((numbers.cell().start_poses[0].X_WB.p - p_W).norm(), 1e-12);
    }
}

TEST(Formulas, TheFrozenTaskAndListGiveTheSameTrials) {
    Formulas files;
    const session::Plan plan = session::make_plan(files.request(5));
    const session::Plan again = session::make_plan(files.request(5));
    const std::string list = files.folder.file("list.csv");
    write_csv(frozen_list(*plan.task, plan.scene), list);
    const std::string other = files.folder.file("again.csv");
    write_csv(frozen_list(*again.task, again.scene), other);
    EXPECT_EQ(testing::read_file(list), testing::read_file(other));

    Task task;
    Diagnostics diagnostics;
    const std::string file =
        files.folder.write("task.yaml", to_yaml(write_fields(plan.task->task)));
    read_fields(task, read_yaml(file), diagnostics);
    TaskPlan frozen = plan_task(task, plan.scene, diagnostics);
    diagnostics.throw_if_errors();
    frozen.trials = read_trial_list(frozen.task, list);
    ASSERT_EQ(frozen.trials.size(), plan.task->trials.size());
    TrialNumbers before(*plan.task);
    TrialNumbers after(frozen);
    for (int i = 0; i < static_cast<int>(frozen.trials.size()); ++i) {
        const auto k = static_cast<size_t>(i);
        EXPECT_EQ(frozen.trials[k].draws, plan.task->trials[k].draws);
        before.begin(i, 1, plan.task->start);
        after.begin(i, 1, frozen.start);
        EXPECT_EQ(before.cell().p_W, after.cell().p_W);  // identical bit by bit
        for (size_t r = 0; r < before.cell().regions.size(); ++r)
            EXPECT_EQ(before.cell().regions[r].radius.value, after.cell().regions[r].radius.value);
        EXPECT_EQ(before.of(plan.task->task.states[0].exits[0].hold),
                  after.of(frozen.task.states[0].exits[0].hold));
    }
}

TEST(Formulas, ATaskWithoutThemHasTheListThatItAlwaysHad) {
    session::Files files;
    const session::Plan plan = session::make_plan(files.request());
    const Table list = frozen_list(*plan.task, plan.scene);
    EXPECT_EQ(list.columns.size(),
              kTrialListColumns.size() + 13);  // plus the columns for the reach
    const std::string task = to_yaml(write_fields(plan.task->task));
    for (const char* key : {"draws", "variables", "after_trial", "cross", "factors", "until"})
        EXPECT_EQ(task.find(key), std::string::npos) << key;
}

TEST(Formulas, ARecoveredSessionHasItsColumnsAndAResumedOneGoesOnWithItsVariables) {
    Formulas files;
    session::RunResult whole = files.run(session::make_plan(files.request()));
    finish(whole);
    whole.lock.reset();
    const std::string trials = testing::read_file(whole.folder + "/trials.csv");
    fs::remove(whole.folder + "/trials.csv");
    analysis::recover_session(recording::SessionFolder::open(whole.folder), {});
    EXPECT_EQ(testing::read_file(whole.folder + "/trials.csv"), trials);

    for (const int ticks : {150, 1000, 1900}) {
        session::RunResult cut = files.run(session::make_plan(files.request()));
        cut.lock.reset();
        recording::RawLogReader all(cut.folder + "/raw.log");
        const recording::LogHead head = all.head();
        std::vector<frame::Frame> frames;
        for (int i = 0; i < ticks; ++i) frames.push_back(*all.next());
        fs::remove(cut.folder + "/raw.log");
        {
            recording::RawLogWriter log(cut.folder + "/raw.log", head);
            std::vector<std::byte> bytes(recording::most_bytes(head.layout(), 100));
            for (const frame::Frame& frame : frames) {
                const size_t size = recording::encode(frame, bytes, recording::Bodies::all);
                log.add(std::span(bytes).first(size));
            }
        }
        analysis::recover_session(recording::SessionFolder::open(cut.folder), {});
        recording::SessionInfo info;
        const session::RunResult rest =
            files.run(session::make_rest(cut.folder, session::Seat::terminal, info));
        finish(rest);
        for (const char* name : {"trial_num", "wait_s", "which", "score", "next_score", "reach_mm",
                                 "next_reach_mm", "outcome"})
            EXPECT_EQ(column(rest.folder, name), column(whole.folder, name)) << name << ticks;
    }
}

TEST(Formulas, AreKeptWithinBoundsWhereVariablesLeaveThem) {
    Formulas files;
    files.replace("after_s: wait", "after_s: (score - 5) / 100");
    const session::Plan plan = session::make_plan(files.request());
    ASSERT_FALSE(plan.warnings.empty());
    EXPECT_NE(plan.warnings.front().text().find("gives -0.05 in trial 1"), std::string::npos)
        << plan.warnings.front().text();
    const session::RunResult result = files.run(plan);
    const auto& notes = result.info.notes;
    EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
        return note.find("kept within its bounds, 1 time in all") != std::string::npos;
    }));
}

TEST(Formulas, AllocateNothingInTheTick) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Formulas files;
    session::expect_no_allocation(session::make_plan(files.request()), 30);
}

TEST(Formulas, AnAngleIsInRadiansWhereItNamesOneAndElseInTheUnitOfItsKey) {
    session::Files files;
    files.replace("task:\n", "task:\n  draws: [{ name: turn_deg, choice: [20, 40] }]\n");
    const auto angle_of = [&](const std::string& text) {
        session::Files mine;
        mine.experiment = files.experiment;
        mine.replace("angle_deg: 30", "angle_deg: " + text);
        const session::Plan plan = session::make_plan(mine.request());
        TrialNumbers numbers(*plan.task);
        numbers.begin(0, 1, {});
        const auto& spec = plan.task->task.perturbations[0];
        const double turn = plan.task->trials[0].draws[0];
        return std::pair(numbers.of(spec.visual->angle) / kDegree, turn);
    };
    EXPECT_NEAR(angle_of("10 * 3").first, 30, 1e-12);
    EXPECT_NEAR(angle_of("0.5 rad").first, 0.5 / kDegree, 1e-12);
    const auto [angle, turn] = angle_of("turn / 2");
    EXPECT_NEAR(angle, turn / 2, 1e-12);
}

TEST(Formulas, InsertedTrialsHaveTheirConditionsInTurn) {
    session::Files files;
    files.replace("insert: [{ kind: catch, count: 1 }]",
                  "conditions: [right], insert: [{ kind: catch, count: 2, conditions: [far] }]");
    files.replace("repeats: 2, ramp: 2", "repeats: 6, ramp: 2");
    const session::Plan plan = session::make_plan(files.request());
    int caught = 0;
    for (const Trial& trial : plan.task->trials) {
        if (trial.block != 1) continue;
        const bool is_catch = trial.kind == TrialKind::catch_trial;
        EXPECT_EQ(trial.condition, is_catch ? 1 : 0);
        caught += is_catch ? 1 : 0;
    }
    EXPECT_EQ(caught, 2);
}

TEST(Formulas, InsertedTrialsKeepTheirGap) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        session::Files files;
        files.replace("insert: [{ kind: catch, count: 1 }]",
                      "insert: [{ kind: catch, count: 2, gap: 3 }]");
        const session::Plan plan = session::make_plan(files.request(seed));
        std::vector<int> at;
        for (const Trial& trial : plan.task->trials) {
            if (trial.kind == TrialKind::catch_trial) at.push_back(trial.in_block);
        }
        ASSERT_EQ(at.size(), 2u);
        EXPECT_GE(at[1] - at[0] - 1, 3);
        EXPECT_GT(at[0], 1);
    }
}

class BrokenFormulas : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenFormulas, AreRefusedWithFileLineAndRemedy) {
    Formulas files;
    session::expect_refused(files, GetParam());
}

const char* const kSide = "{ name: side, choice: [-1, 1] }";
const char* const kCross =
    "  cross:\n    - { factor: mass_g, levels: [100, 200] }\n    - { factor: surface, levels: "
    "[suede, silk] }\n";

INSTANTIATE_TEST_SUITE_P(
    Mistakes, BrokenFormulas,
    ::testing::Values(
        Mistake{"choice: [-1, 1]", "choose: [-1, 1]", "choose"},
        Mistake{kSide, "{ name: side }", "draws nothing"},
        Mistake{kSide, "{ choice: [-1, 1] }", "name"},
        Mistake{kSide, "{ name: side, choice: [-1, 1], participant: yes }", "in several ways"},
        Mistake{"mean: 0.1, ", "", "mean"}, Mistake{"mean: 0.1", "mean: -0.1", "mean"},
        Mistake{"mean: 0.1", "mean: wait", "must be a number"},
        Mistake{"to: 0.3", "to: 0.03", "is 0.03, but 'from' is 0.1"},
        Mistake{kSide, "{ name: side, normal: { mean: 0, sd: 1, from: 9, to: 10 } }",
                "of its probability between"},
        Mistake{kSide, "{ name: side, normal: { mean: 0 } }", "sd"},
        Mistake{kSide, "{ name: side, uniform: { from: 1 } }", "to"},
        Mistake{kSide, "{ name: side, choice: [-1, 1], weights: [1] }", "there are 1 for 2"},
        Mistake{kSide, "{ name: side, choice: [-1, 1], weights: [1, some] }", "must be a number"},
        Mistake{"name: side", "name: my side", "cannot be used in a formula"},
        Mistake{"name: side", "name: wait", "is already the quantity wait"},
        Mistake{"name: side", "name: share", "is already the quantity share"},
        Mistake{"name: side", "name: grip_force_N", "is already the quantity grip_force"},
        Mistake{"name: side", "name: wait_s", "there are two draws 'wait_s'"},
        Mistake{kSide, "{ name: side, choice: [1] }\n    - { name: peak_grip_N, choice: [1] }",
                "another column of trials.csv"},
        Mistake{"name: score }", "name: outcome }", "is already the quantity outcome"},
        Mistake{"start: 40", "start: far", "must be a number"},
        Mistake{"set: score", "set: scroe", "Did you mean score?"},
        Mistake{"'outcome == \"reached\"'", "score + 1", "is not a condition"},
        Mistake{"'outcome == \"reached\"'", "'outcme == \"reached\"'", "outcme"},
        Mistake{"set: score, to: score + 10", "set: score", "to"},
        Mistake{"to: reach + 5 mm", "to: reach * 2 s", "must be a length"},
        Mistake{"until: score >= 60", "until: score", "is not a condition"},
        Mistake{"until: score >= 60", "until: side > 0", "side"},
        Mistake{"levels: [suede, silk]", "levels: [silk, silk]", "the same level twice"},
        Mistake{"levels: [suede, silk]", "levels: []", "there are none"},
        Mistake{"factor: surface", "factor: mass_g", "two factors 'mass_g'"},
        Mistake{"factor: surface", "factr: surface", "factor"},
        Mistake{"  blocks:\n", "  conditions: [{ name: 200 slik }]\n  blocks:\n",
                "not a condition generated by 'cross'"},
        Mistake{kCross, "  conditions: [{ name: a, factors: { mass_g: 1 } }, { name: b }]\n",
                "'b' has no level of mass_g"},
        Mistake{"  blocks:\n", "  rounds: [{ name: a, factors: { side: 1 } }]\n  blocks:\n",
                "'side' is already the quantity side"},
        Mistake{"side * reach", "sied * reach", "sied"},
        Mistake{"side * reach", "wait", "must be a length"},
        Mistake{"side * reach", "side * reach *", "position_mm"},
        Mistake{"after_s: wait", "after_s: wait > 0.1", "must be a number"},
        Mistake{"after_s: wait", "after_s: block.z / 1 m * 1 s", "changes within a trial"},
        Mistake{"after_s: wait", "after_s: wait - 1 s", "in trial 1"},
        Mistake{"position_mm: [0, 0, 120], radius", "position_mm: [target.x, 0, 120], radius",
                "has no value in trial 1"},
        Mistake{"mass / 100 g", "mass / 1 g", "must be from 0.05 to 20"},
        Mistake{"perturb: changed }", "perturb: changed, insert: [{ count: 3, gap: 9 }] }",
                "needs more than the block's 4"},
        Mistake{"perturb: changed }", "perturb: changed, insert: [{ count: 2, gap: 0 }] }",
                "gap"}));

}  // namespace
}  // namespace dihaptic::task::formulas_test
