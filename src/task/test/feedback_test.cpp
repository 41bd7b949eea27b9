// Tests that participants have time to read a trial's feedback: it stays for a while before the
// next message replaces it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/session_report.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"
#include "task/test/resting_hand.h"

namespace dihaptic::task::feedback_test {
namespace {

/// A message, and the times at which it appeared and disappeared [s].
struct Said {
    std::string message;
    double from = 0;
    double until = 0;
    int trials = 1;  // number of trials that ran while the message was shown
};

std::vector<Said> said_in(const session::RunResult& result) {
    std::vector<Said> out;
    recording::RawLogReader log(result.folder + "/raw.log");
    int running = 0;
    while (const frame::Frame* frame = log.next()) {
        const std::string message =
            frame->task.message < 0 ? ""
                                    : log.head().messages[static_cast<size_t>(frame->task.message)];
        const double now = seconds(frame->time);
        if (out.empty() || out.back().message != message) out.push_back({message, now, now, 0});
        out.back().until = now;
        const int trial = frame->phase > 0 ? frame->trial : 0;
        if (trial > 0 && trial != running) ++out.back().trials;
        running = trial;
    }
    return out;
}

TEST(Feedback, StaysForASecondBeforeTheNextTrialAndAfterTheLast) {
    session::Files files;
    const session::RunResult result = files.run(session::make_plan(files.request()));
    EXPECT_EQ(result.fault, "");
    int good = 0;
    for (const Said& said : said_in(result)) {
        if (said.message != "Good") continue;
        ++good;
        EXPECT_NEAR(said.until - said.from, 1, 2e-3) << "at " << said.from << " s";
        EXPECT_EQ(said.trials, 0) << "at " << said.from << " s";
    }
    EXPECT_EQ(good, 9);
    const analysis::SessionFigures figures =
        analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    EXPECT_FALSE(figures.failed());
    const CsvFile trials(result.folder + "/trials.csv");
    ASSERT_EQ(trials.rows(), 9u);
    for (size_t i = 0; i < 9; ++i) EXPECT_EQ(trials.text(i, "outcome"), "reached");
    EXPECT_GE(trials.number(1, "start_time") - trials.number(0, "stop_time"), 0.999);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

TEST(Feedback, StaysForAsLongAsTheFileSaysOrNotAtAll) {
    for (const double seconds : {0.0, 0.3}) {
        session::Files files;
        files.replace("  redo: next\n", fmt::format("  redo: next\n  feedback_s: {}\n", seconds));
        int good = 0;
        for (const Said& said : said_in(files.run(session::make_plan(files.request())))) {
            if (said.message != "Good") continue;
            ++good;
            EXPECT_NEAR(said.until - said.from, seconds, 2e-3);
        }
        EXPECT_EQ(good, 9);
    }
}

TEST(Feedback, InATrialHoldsBackTheNextStatesMessageButNotTheState) {
    session::Files files;
    files.replace("        - { when: outside, region: shell, outcome: reached, feedback: Good }",
                  "        - { when: outside, region: shell, to: back, feedback: Good }");
    files.replace("  reach: { from",
                  "    - name: back\n      message: Go back\n      exits:\n"
                  "        - { when: time, after_s: 1.5, outcome: reached }\n  reach: { from");
    const std::vector<Said> said = said_in(files.run(session::make_plan(files.request())));
    int back = 0;
    for (size_t i = 1; i < said.size(); ++i) {
        if (said[i].message != "Go back") continue;
        ++back;
        EXPECT_EQ(said[i - 1].message, "Good");
        EXPECT_NEAR(said[i - 1].until - said[i - 1].from, 1, 2e-3);
        EXPECT_NEAR(said[i].until - said[i].from, 0.5, 3e-3);  // for the rest of the state's time
    }
    EXPECT_EQ(back, 9);
}

TEST(Feedback, WhatIsPressedMeanwhileAnswersNoLaterTrial) {
    session::Files files;
    files.replace("- { when: outside, region: shell, outcome: reached, feedback: Good }",
                  "- { when: key, key: y, outcome: reached, feedback: Good }");
    const session::Plan plan = session::make_plan(files.request());
    test::RestingHand hand(plan);
    const frame::Commands& commands = hand.commands;
    int tick = 0;
    const auto run = [&](double time, const char key) {
        for (; tick < time * 1e3; ++tick) {
            if (key != 0) hand.director.press(key);
            hand.tick();
        }
    };
    run(0.5, 0);
    EXPECT_EQ(commands.phase, 2);  // reach
    run(0.502, 'y');
    EXPECT_EQ(commands.phase, 0);
    run(1.4, 'y');
    EXPECT_EQ(commands.phase, 0);
    run(2, 0);
    EXPECT_EQ(commands.trial, 2);
    EXPECT_EQ(commands.phase, 2);
}

}  // namespace
}  // namespace dihaptic::task::feedback_test
