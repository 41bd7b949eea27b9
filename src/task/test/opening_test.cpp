// Tests the opening of a block: a break, and pages of text and pictures.
#include "task/run/opening.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "analysis/session_report.h"
#include "frame/shown_texts.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"
#include "task/run/task_director.h"

namespace dihaptic::task::opening_test {
namespace {

const char* const kFirst = "{ name: before, kind: baseline, repeats: 1 }";
const char* const kSecond = "{ name: turned, kind: perturbed,";

/// A director that is called tick by tick, with one finger at the start and the block in its
/// initial position.
struct Asked {
    explicit Asked(session::Files& files) : plan(session::make_plan(files.request())) {
        last.fingers.resize(1);
        for (const scene::Body& body : plan.scene.bodies) last.bodies.push_back({body.pose()});
        last.fingers[0].p_WP = handles[0].p_WH;
        commands.task.reserve({last.bodies.size()});
    }
    /// Runs until the time `until` [s]. `key` is pressed in the first tick, unless it is 0.
    const frame::Commands& run(double until, char key = 0) {
        for (; tick < until * 1e3; ++tick, key = 0) {
            last.sequence = tick;
            last.time = from_seconds(tick * 1e-3);
            if (key != 0) director.press(key);
            commands.clear();
            director(last, handles, commands);
        }
        return commands;
    }

    session::Plan plan;
    TaskDirector director{*plan.task, 1, 1e-3};
    frame::Frame last;
    std::vector<frame::Handle> handles{{{0, 0, 0.12}, Vec3::Zero()}};
    frame::Commands commands;
    int tick = 0;
};

TEST(Opening, PagesWaitForTheirKeyOrTheirTime) {
    session::Files files;
    files.replace(
        kFirst,
        "{ name: before, pages: [{ text: \"Hello. {trials} trials\" }, { text: Ready, key: y "
        "}, { text: Steady, for_s: 0.5 }] }");
    Asked asked(files);
    asked.run(0.2);
    EXPECT_EQ(asked.commands.task.page, 0);
    EXPECT_EQ(asked.commands.phase, kBetween);
    EXPECT_EQ(frame::shown_texts(asked.commands.task, asked.plan.task->messages),
              std::vector<std::string>{"Hello. 9 trials"});
    asked.run(0.3, 'q');  // any key
    EXPECT_EQ(asked.commands.task.page, 1);
    asked.run(0.4, 'q');
    EXPECT_EQ(asked.commands.task.page, 1);
    asked.run(0.5, 'y');
    EXPECT_EQ(asked.commands.task.page, 2);
    asked.run(0.89);
    EXPECT_EQ(asked.commands.task.page, 2);
    asked.run(0.91);  // 0.5 s after the key press on the second page
    EXPECT_EQ(asked.commands.task.page, -1);
    EXPECT_EQ(asked.commands.phase, 1);
    EXPECT_EQ(asked.commands.trial, 1);
}

TEST(Opening, AKeyThatWasPressedBeforeThePageTurnsNone) {
    session::Files files;
    files.replace(kFirst, "{ name: before, pages: [{ text: Hello }] }");
    Asked asked(files);
    asked.run(0.001, 'q');
    asked.run(1);
    EXPECT_EQ(asked.commands.task.page, 0);
}

TEST(Opening, ASimulatedSessionGoesOnByItselfRestsAndReplays) {
    session::Files files;
    std::filesystem::copy_file("src/view/test/bead.png", files.folder.file("bead.png"));
    files.replace(kFirst, "{ name: before, pages: [{ text: Hello, picture: bead.png }] }");
    files.replace(kSecond,
                  "{ name: turned, rest_s: 2, pages: [{ text: Now it turns }], kind: perturbed,");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    EXPECT_EQ(result.fault, "");
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    const analysis::SessionFigures figures =
        analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    EXPECT_FALSE(figures.failed());
    const CsvFile trials(result.folder + "/trials.csv");
    ASSERT_EQ(trials.rows(), 9u);
    for (size_t i = 0; i < 9; ++i) EXPECT_EQ(trials.text(i, "outcome"), "reached");

    recording::RawLogReader log(result.folder + "/raw.log");
    const std::vector<std::string> messages = log.head().messages;
    EXPECT_EQ(log.head().pages, (std::vector<std::string>{"bead.png", "Now it turns"}));
    std::map<std::string, int> ticks;
    std::vector<double> left;
    while (const frame::Frame* frame = log.next()) {
        const auto texts = frame::shown_texts(frame->task, messages);
        const std::string said = texts.empty() ? "" : texts.front();
        ++ticks[said];
        EXPECT_EQ(frame->task.page, said == "Hello" ? 0 : said == "Now it turns" ? 1 : -1);
        if (said != "Take a break") continue;
        EXPECT_EQ(frame->trial, 3);
        ASSERT_EQ(frame->task.numbers.size(), 1u);
        if (left.empty() || left.back() != frame->task.numbers[0].value)
            left.push_back(frame->task.numbers[0].value);
    }
    EXPECT_NEAR(ticks["Take a break"], 2000, 2);
    EXPECT_EQ(left, (std::vector<double>{2, 1}));
    EXPECT_GT(ticks["Hello"], 500);
    EXPECT_LE(ticks["Hello"], 1001);
    EXPECT_GT(ticks["Now it turns"], 0);

    std::multiset<std::string> pages;
    for (const auto& row : read_csv(result.folder + "/events.csv")) {
        if (row[2] == "page") pages.insert(row[3]);
    }
    EXPECT_EQ(pages, (std::multiset<std::string>{"bead.png", "Now it turns"}));
    // the folder contains the picture under the name used in its task
    EXPECT_TRUE(std::filesystem::exists(result.folder + "/page-1-bead.png"));
    EXPECT_NE(testing::read_file(result.folder + "/task.yaml").find("page-1-bead.png"),
              std::string::npos);
}

TEST(Opening, OfNoBlockMakesASessionWhatItWas) {
    session::Files files;
    const session::Plan plan = session::make_plan(files.request());
    EXPECT_EQ(plan.task->messages,
              (std::vector<std::string>{"Take the hands off the objects, 13 mm away", "Go home",
                                        "Good"}));
    EXPECT_TRUE(plan.task->pages.empty());
    EXPECT_EQ(longest_opening(*plan.task), 0);
}

}  // namespace
}  // namespace dihaptic::task::opening_test
