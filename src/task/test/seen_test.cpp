// Tests what a person sees in each state: which things are hidden, held, late or shaken, how things
// look, and the texts with their numbers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "analysis/session_report.h"
#include "base/field_writer.h"
#include "base/number.h"
#include "frame/displayed.h"
#include "frame/shown_texts.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"
#include "task/test/resting_hand.h"
#include "testing/allocation_guard.h"

namespace dihaptic::task::seen_test {
namespace {

constexpr int kHome = 1;
constexpr int kReach = 2;
const char* const kRotation = "about: start, axis: [0, 0, 1], angle_deg: 30 }";

struct Told {
    std::vector<frame::Frame> frames;
    recording::LogHead head;
    std::string folder;
};

/// Runs the session of the files, which must replay exactly.
Told tell(session::Files& files) {
    const session::RunResult result = files.run(session::make_plan(files.request()));
    EXPECT_EQ(result.fault, "");
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    Told out;
    out.folder = result.folder;
    recording::RawLogReader log(result.folder + "/raw.log");
    out.head = log.head();
    while (const frame::Frame* frame = log.next()) out.frames.push_back(*frame);
    return out;
}

std::map<std::string, std::set<std::string>> events_of(const Told& told,
                                                       const session::RunResult& result) {
    analysis::finish_session(recording::SessionFolder::open(told.folder), result.info, {});
    std::map<std::string, std::set<std::string>> out;
    for (const auto& row : read_csv(told.folder + "/events.csv")) out[row[2]].insert(row[3]);
    return out;
}

bool finger_is_displayed(const frame::Frame& frame) {
    return frame::is_displayed(frame, frame::proxy_of(frame, 0));
}

TEST(Seen, AStateHidesCursorObjectAndBodies) {
    session::Files files;
    files.keep_first_block();
    files.replace("show: [target]",
                  "show: { targets: [target], cursor: no, bodies: { table: no } }");
    int hidden = 0;
    int begun = 0;
    for (const frame::Frame& frame : tell(files).frames) {
        if (frame.phase != kBetween) begun = frame.phase;
        if (frame.phase == kReach) {
            EXPECT_EQ(frame.task.targets.size(), frame.task.outcome < 0 ? 1u : 0u);
        }
        // between trials, everything stays as it was in the last state
        EXPECT_EQ(finger_is_displayed(frame), begun != kReach);
        EXPECT_EQ(frame::is_displayed(frame, 0), begun != kReach);
        EXPECT_TRUE(frame::is_displayed(frame, 1));
        hidden += begun == kReach ? 1 : 0;
    }
    EXPECT_GT(hidden, 200);
    session::Files object;
    object.keep_first_block();
    object.replace("show: [target]", "show: { object: no, cursor: no, fingers: { index: yes } }");
    for (const frame::Frame& frame : tell(object).frames) {
        if (frame.phase != kReach) continue;
        EXPECT_FALSE(frame::is_displayed(frame, 1));
        EXPECT_TRUE(finger_is_displayed(frame));
        EXPECT_TRUE(frame.task.targets.empty());
    }
}

TEST(Seen, AListOfTargetsIsWrittenAsItWas) {
    session::Files files;
    const auto written = [&] {
        return to_yaml(write_fields(session::make_plan(files.request()).task->task));
    };
    EXPECT_EQ(written().find("targets:"), std::string::npos);
    files.replace("show: [target]", "show: { targets: [target], cursor: held }");
    const std::string text = written();
    EXPECT_NE(text.find("targets:"), std::string::npos);
    // reading the written text must give the same task
    Task again;
    Diagnostics diagnostics;
    read_fields(again, parse_yaml(text, "task.yaml"), diagnostics);
    EXPECT_TRUE(diagnostics.problems().empty());
    EXPECT_EQ(to_yaml(write_fields(again)), text);
    EXPECT_EQ(again.states[1].show.cursor, Cursor::held);
}

TEST(Seen, AHeldCursorStaysWhereItWasWhenTheStateBegan) {
    session::Files files;
    files.replace("show: [target]", "show: { cursor: no }");
    files.replace("region: shell, outcome: reached, feedback: Good }", "region: shell, to: end }");
    files.replace("  reach: { from",
                  "    - name: end\n      show: { cursor: held }\n      perturbed: no\n"
                  "      exits: [{ when: time, after_s: 0.3, outcome: reached }]\n  reach: { from");
    constexpr int kEnd = 3;
    const Told told = tell(files);
    Pose held;
    int ends = 0;
    bool moved = false;
    for (size_t i = 1; i < told.frames.size(); ++i) {
        const frame::Frame& frame = told.frames[i];
        if (frame.phase != kEnd) continue;
        if (told.frames[i - 1].phase != kEnd) {
            ++ends;
            held = frame::mapped_proxy(told.frames[i - 1],
                                       0);  // includes the perturbation at that time
        }
        EXPECT_TRUE(finger_is_displayed(frame));
        EXPECT_EQ(frame::displayed_proxy(frame, 0).p, held.p);
        moved = moved || (frame.fingers[0].p_WP - held.p).norm() > 1e-3;
    }
    EXPECT_EQ(ends, 9);
    EXPECT_TRUE(moved);
}

TEST(Seen, ADelayedCursorIsWhereItWasThatLongAgo) {
    session::Files files;
    files.replace(kRotation, "about: start, axis: [0, 0, 1], angle_deg: 30, delay_ms: 80 }");
    const Told told = tell(files);
    std::set<int> delays;
    for (size_t i = 200; i < told.frames.size(); ++i) {
        const frame::Frame& frame = told.frames[i];
        if (frame.task.displaced.empty()) continue;
        ASSERT_EQ(frame.task.visual.size(), 1u);
        const double delay = frame.task.visual[0].delay;
        EXPECT_NEAR(delay, 0.08 * frame.task.share, 1e-12);  // half in the ramp's first trial
        const auto ticks = static_cast<size_t>(std::lround(delay / 1e-3));
        delays.insert(static_cast<int>(ticks));
        EXPECT_EQ(frame::displayed_proxy(frame, 0).p,
                  frame::mapped_proxy(told.frames[i - ticks], 0).p);
    }
    EXPECT_EQ(delays, (std::set<int>{40, 80}));
}

TEST(Seen, NoiseShakesTheCursorAsTheSeedHasIt) {
    session::Files files;
    files.replace("about: start, axis: [0, 0, 1], angle_deg: 30 }", "noise_mm: [2, 1, 0] }");
    const Told told = tell(files);
    const Told again = tell(files);
    ASSERT_EQ(told.frames.size(), again.frames.size());
    std::vector<Vec3> shakes;
    for (size_t i = 1; i < told.frames.size(); ++i) {
        const frame::Frame& frame = told.frames[i];
        if (frame.task.displaced.empty()) continue;
        const Vec3 shake =
            frame::displayed_proxy(frame, 0).p - frame::mapped_proxy(told.frames[i - 1], 0).p;
        EXPECT_EQ(frame::displayed_proxy(again.frames[i], 0).p, frame::displayed_proxy(frame, 0).p);
        EXPECT_NEAR(shake.z(), 0, 1e-15);
        const Vec3 whole = shake / frame.task.share;
        if (shakes.empty() || (whole - shakes.back()).norm() > 1e-9) shakes.push_back(whole);
    }
    ASSERT_GT(shakes.size(), 20u);  // noise is drawn 60 times a second
    double x = 0;
    double y = 0;
    for (const Vec3& shake : shakes) {
        x += shake.x() * shake.x() / static_cast<double>(shakes.size());
        y += shake.y() * shake.y() / static_cast<double>(shakes.size());
    }
    EXPECT_NEAR(std::sqrt(x), 2e-3, 1e-3);
    EXPECT_NEAR(std::sqrt(y), 1e-3, 0.5e-3);
}

TEST(Seen, ConditionsAndStatesColourAndSizeThings) {
    session::Files files;
    files.keep_first_block();
    files.replace(
        "- name: far\n",
        "- name: far\n      look: [{ target: target, colour: \"#00ff00\" }, { body: block, "
        "scale: 2 }]\n");
    files.replace("show: [target]\n",
                  "show: [target]\n      look: [{ target: target, scale: 1.5 }, { finger: index, "
                  "colour: \"#000000\" }, { body: block, colour: \"#0000ff\", scale: 1.5 }]\n");
    const session::Plan plan = session::make_plan(files.request());
    std::set<int> conditions;
    for (const frame::Frame& frame : tell(files).frames) {
        if (frame.phase != kReach || frame.task.outcome >= 0) continue;
        const int condition = plan.task->trials[static_cast<size_t>(frame.trial - 1)].condition;
        conditions.insert(condition);
        ASSERT_EQ(frame.task.targets.size(), 1u);
        EXPECT_EQ(frame.task.targets[0].colour, condition == 1 ? 0x00ff00 : -1);
        EXPECT_NEAR(frame.task.targets[0].radius, 0.009, 1e-12);
        EXPECT_EQ(frame::item_of(frame.task.looks, frame::proxy_of(frame, 0))->colour, 0);
        EXPECT_EQ(frame::item_of(frame.task.looks, 1)->colour, 0x0000ff);
        EXPECT_NEAR(frame::displayed_size(frame, 1), condition == 1 ? 3 : 1.5, 1e-12);
    }
    EXPECT_EQ(conditions.size(), 2u);
}

/// In one of the conditions, the cursor and the target are hidden during the reach, and the block
/// is hidden throughout.
TEST(Seen, ConditionsHideThings) {
    session::Files files;
    files.keep_first_block();
    files.replace("- name: far\n",
                  "- name: far\n      look: [{ finger: index, hidden: yes, during: reach }, "
                  "{ target: target, hidden: yes, during: [reach] }, { body: block, hidden: yes "
                  "}]\n");
    files.replace("show: [target]\n",
                  "show: [target]\n      look: [{ finger: index, colour: \"#ff0000\" }]\n");
    const session::Plan plan = session::make_plan(files.request());
    std::map<std::pair<int, int>, int> hidden;  // keyed by condition and phase
    for (const frame::Frame& frame : tell(files).frames) {
        if (frame.phase == 0 || frame.task.outcome >= 0) continue;
        const int condition = plan.task->trials[static_cast<size_t>(frame.trial - 1)].condition;
        const bool no_cursor = !frame::is_displayed(frame, frame::proxy_of(frame, 0));
        const bool no_target = frame.task.targets.empty();
        const bool no_block = !frame::is_displayed(frame, 1);
        hidden[{condition, frame.phase}] = 4 * no_cursor + 2 * no_target + no_block;
    }
    EXPECT_EQ((hidden[{0, 1}]), 0);
    EXPECT_EQ((hidden[{0, kReach}]), 0);
    EXPECT_EQ((hidden[{1, 1}]), 1);
    EXPECT_EQ((hidden[{1, kReach}]), 7);
}

TEST(Seen, TextsHaveLinesNumbersAndACountdown) {
    session::Files files;
    files.replace(
        "message: Go home\n",
        "message: \"Trial {trial_num} of {trials}\"\n      lines: [\"{trials_left} left\"]\n"
        "      countdown: yes\n");
    files.replace(
        "  redo: next\n",
        "  redo: next\n  feedback_beside: yes\n  lines: [\"Block {block_num}/{blocks}\"]\n");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    Told told;
    told.folder = result.folder;
    recording::RawLogReader log(result.folder + "/raw.log");
    const std::vector<std::string> messages = log.head().messages;
    int homes = 0;
    int good = 0;
    while (const frame::Frame* frame = log.next()) {
        const auto texts = frame::shown_texts(frame->task, messages);
        const std::string trial = "Trial " + number_text(frame->trial) + " of 9";
        const int block = frame->trial < 3 ? 1 : frame->trial < 8 ? 2 : 3;
        const std::string where = "Block " + number_text(block) + "/3";
        if (frame->phase == kHome && frame->task.lines.size() == 3) {
            ++homes;
            const std::string left = number_text(10 - frame->trial) + " left";
            EXPECT_EQ(texts, (std::vector<std::string>{trial, "5", left, where}));
        } else if (frame->phase == kReach && frame->task.outcome < 0) {
            EXPECT_EQ(texts, (std::vector<std::string>{trial, where}));
        }
        if (std::find(texts.begin(), texts.end(), "Good") != texts.end()) ++good;
    }
    EXPECT_GT(homes, 9 * 190);
    EXPECT_NEAR(good, 9 * 1000, 30);
    const auto events = events_of(told, result);
    EXPECT_TRUE(events.at("message").contains("Trial 1 of 9"));
    EXPECT_TRUE(events.at("line").contains("Good"));
    EXPECT_TRUE(events.at("line").contains("1 left"));
}

TEST(Seen, TextsNameVariablesDrawsAndWhatIsMeasured) {
    session::Files files;
    files.replace("message: Go home\n", "message: \"Score {score}, wait {wait:.3f}\"\n");
    files.replace("  redo: next\n",
                  "  redo: next\n  lines: [\"{index.z:.4f}\"]\n"
                  "  draws: [{ name: wait_ms, uniform: { from: 100, to: 200 } }]\n"
                  "  variables: [{ name: score, start: 5 }]\n"
                  "  after_trial: [{ set: score, to: score + 10 }]\n");
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    recording::RawLogReader log(result.folder + "/raw.log");
    const std::vector<std::string> messages = log.head().messages;
    int homes = 0;
    double z = 0.12;
    while (const frame::Frame* frame = log.next()) {
        const auto texts = frame::shown_texts(frame->task, messages);
        if (frame->phase == kHome && frame->task.outcome < 0) {
            ++homes;
            const Trial& trial = plan.task->trials[static_cast<size_t>(frame->trial - 1)];
            EXPECT_EQ(texts.at(0), fmt::format("Score {}, wait {:.3f}", 10 * frame->trial - 5,
                                               trial.draws.at(0) / 1000));
            EXPECT_NEAR(finite_number(texts.at(1)).value(), z, 5e-5 + 1e-3);  // to within one tick
        }
        z = frame->fingers.at(0).p_WH.z();
    }
    EXPECT_GT(homes, 9 * 190);
}

TEST(Seen, NothingIsAllocatedInTheTick) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    session::Files files;
    files.replace(kRotation,
                  "about: start, axis: [0, 0, 1], angle_deg: 30, delay_ms: 80, "
                  "noise_mm: [1, 1, 1] }");
    files.replace("show: [target]",
                  "show: { targets: [target], bodies: { block: no } }\n      "
                  "lines: [\"{trial_num}\"]");
    files.replace("{ name: before, kind: baseline, repeats: 1 }",
                  "{ name: before, kind: perturbed, perturb: rotation, pages: [{ text: Hello }] }");
    const session::Plan plan = session::make_plan(files.request());
    test::RestingHand hand(plan);
    bool displaced = false;
    const testing::AllocationGuard guard;
    for (int tick = 0; tick < 1000; ++tick) {
        if (tick == 50) hand.director.press('x');
        displaced = displaced || !hand.tick().task.displaced.empty();
    }
    EXPECT_EQ(guard.count(), 0u);
    EXPECT_TRUE(displaced);
}

}  // namespace
}  // namespace dihaptic::task::seen_test
