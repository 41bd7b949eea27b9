// Tests forms: several questions in one state, with answers that take effect only once they are
// confirmed.
#include "task/file/form.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/recovery.h"
#include "person/population.h"
#include "session/replay.h"
#include "session/test/reaches.h"
#include "task/test/resting_hand.h"

namespace dihaptic::task::form_test {
namespace {

using session::Mistake;

const char* const kForm = R"(title: How was it?
version: "3"
items:
  - { name: effort, question: 'How hard?', scale: numbers, from: 0, to: 20, labels: [easy, hard] }
  - { name: comfort, question: 'How comfortable?', scale: likert, from: -1, labels: [un, so so, well] }
  - { name: sleep_s, question: 'Seconds asleep?', scale: magnitude, optional: yes }
scores:
  - { name: sum, of: effort + 10 * comfort }
)";

const char* const kTask = R"(title: Form
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  states:
    - name: move
      exits: [{ when: time, after_s: 0.01, outcome: moved }]
    - name: ask
      form: { file: form.yaml }
      exits:
        - { when: answered, outcome: filled }
        - { when: time, after_s: 5, outcome: too late }
  blocks:
    - { name: moves, repeats: 1 }
    - { name: form, begins: ask, repeats: 1 }
)";

constexpr int kUnread = 201;  // number of initial ticks in which a form accepts no answers

struct Forms : session::Files {
    Forms() { experiment = kTask; }
    session::Plan plan() {
        folder.write("form.yaml", form);
        return session::make_plan(request());
    }
    std::string form = kForm;
};

/// Returns the director's commands at the end of the trial with the form. While the form is shown,
/// keys are pressed, one in every other tick.
frame::TaskFrame filled(const session::Plan& plan, const std::string& keys,
                        std::vector<std::string>* lines = nullptr) {
    test::RestingHand hand(plan);
    size_t at = 0;
    int ticks = 0;  // number of ticks in the form's state
    for (int i = 0; i < 20000; ++i) {
        const frame::Commands& commands = hand.tick();
        if (commands.phase == 2 && commands.task.outcome >= 0) return commands.task;
        if (commands.phase != 2) continue;
        if (lines != nullptr && !commands.task.lines.empty()) {
            const auto message = static_cast<size_t>(commands.task.lines.front().message);
            const std::string& line = plan.task->messages[message];
            if (lines->empty() || lines->back() != line) lines->push_back(line);
        }
        if (++ticks > kUnread && i % 2 == 0 && at < keys.size()) hand.director.press(keys[at++]);
    }
    ADD_FAILURE() << "the trial did not end";
    return {};
}

std::vector<double> answers(const frame::TaskFrame& task) {
    std::vector<double> out;
    for (const frame::VariableFrame& variable : task.variables) out.push_back(variable.value);
    return out;
}

TEST(Form, AsksItsItemsInTurnAndThenForConfirmation) {
    Forms files;
    const session::Plan plan = files.plan();
    std::vector<std::string> lines;
    const frame::TaskFrame end = filled(plan, "12\r1\r7\r\r", &lines);
    EXPECT_EQ(answers(end), (std::vector<double>{12, 1, 7}));
    EXPECT_EQ(plan.task->outcomes[static_cast<size_t>(end.outcome)].name, "filled");
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0], "1 of 3: How hard?");
    EXPECT_EQ(lines[2], "3 of 3: Seconds asleep?");
    EXPECT_NE(lines[3].find("Enter: done"), std::string::npos);
}

TEST(Form, TrialsOfABlockBeginInItsState) {
    Forms files;
    const session::Plan plan = files.plan();
    test::RestingHand hand(plan);
    std::vector<int> phases;
    for (int i = 0; i < 20000 && !hand.commands.stop; ++i) {
        const frame::Commands& commands = hand.tick();
        if (phases.empty() || phases.back() != commands.phase) phases.push_back(commands.phase);
    }
    EXPECT_EQ(phases, (std::vector<int>{1, 2}));
}

TEST(Form, AnswersMayBeChangedUntilTheyAreConfirmed) {
    Forms files;
    const frame::TaskFrame end = filled(files.plan(), "12\r1\r7\r\b\b\b5\r0\r8\r\r");
    EXPECT_EQ(answers(end), (std::vector<double>{5, 0, 8}));
}

TEST(Form, AnItemMayBeLeftOutOnlyIfItIsOptional) {
    Forms files;
    const frame::TaskFrame end = filled(files.plan(), "\r3\r1\r\r\r");
    ASSERT_EQ(answers(end).size(), 3u);
    EXPECT_EQ(answers(end)[0], 3);
    EXPECT_EQ(answers(end)[1], 1);
    EXPECT_TRUE(std::isnan(answers(end)[2]));
}

TEST(Form, EnterAfterANumberThatIsCompleteLeavesNothingOut) {
    Forms files;
    files.form.replace(files.form.find("optional: yes"), 13, "optional: no ");
    files.form.insert(files.form.find(", labels: [un"), ", optional: yes");
    // 20 is complete because no digit can follow it, so the Enter after it must not skip the next
    // item
    const frame::TaskFrame end = filled(files.plan(), "20\r1\r7\r\r");
    EXPECT_EQ(answers(end), (std::vector<double>{20, 1, 7}));
}

/// A window that draws slowly passes on all keys typed in the meantime at once.
TEST(Form, LosesNoKeyOfThoseThatComeAtOnce) {
    Forms files;
    const session::Plan plan = files.plan();
    test::RestingHand hand(plan);
    int ticks = 0;
    for (int i = 0; i < 2000; ++i) {
        const frame::Commands& commands = hand.tick();
        if (commands.phase == 2 && commands.task.outcome >= 0) {
            EXPECT_EQ(answers(commands.task), (std::vector<double>{12, -1, 123456}));
            return;
        }
        if (commands.phase == 2 && ++ticks == kUnread) {
            for (const char key :
                 {'1', '2', '\r', '-', '1', '\r', '1', '2', '3', '4', '5', '6', '\r', '\r'})
                hand.director.press(key);
        }
    }
    FAIL() << "the trial did not end";
}

TEST(Form, TakesNoAnswersBeforeItCanHaveBeenRead) {
    Forms files;
    const session::Plan plan = files.plan();
    test::RestingHand hand(plan);
    int ticks = 0;
    for (int i = 0; i < 1000 && hand.commands.phase != 2; ++i) hand.tick();
    while (++ticks < kUnread - 1) {
        hand.director.press(ticks % 2 == 0 ? '7' : '\r');
        hand.tick();
        EXPECT_TRUE(std::isnan(hand.commands.task.variables[0].value)) << ticks;
    }
}

TEST(Form, ItsScoresAreMeasuresOfTheTask) {
    Forms files;
    const session::Plan plan = files.plan();
    ASSERT_EQ(plan.task->task.custom_measures.size(), 1u);
    EXPECT_EQ(plan.task->task.custom_measures[0].name, "sum");
    EXPECT_EQ(plan.task->task.custom_measures[0].during, (std::vector<std::string>{"ask"}));
}

TEST(Form, IsClickedInAnyOrderAndConfirmedByTheButton) {
    Forms files;
    for (const char* scale : {"scale: numbers", "scale: likert"})
        files.form.insert(files.form.find(scale), "by: mouse, ");
    const session::Plan plan = files.plan();
    test::RestingHand hand(plan);
    const std::vector<Click> clicks{Click::at(3, 0), Click::at(1, 1), Click::at(0, 0.5),
                                    Click::at(0, 0.25), Click::at(3, 0)};
    size_t at = 0;
    int ticks = 0;  // number of ticks in the form's state
    for (int i = 0; i < 20000; ++i) {
        const frame::Commands& commands = hand.tick();
        if (commands.phase == 2 && commands.task.outcome >= 0) {
            EXPECT_EQ(answers(commands.task)[0], 5);
            EXPECT_EQ(answers(commands.task)[1], 1);
            EXPECT_EQ(plan.task->outcomes[static_cast<size_t>(commands.task.outcome)].name,
                      "filled");
            return;
        }
        if (commands.phase != 2 || ++ticks < kUnread || i % 2 != 0) continue;
        if (at == 4) hand.director.press('\r');  // skips the last item
        if (at < clicks.size()) hand.director.click(clicks[at++]);
    }
    FAIL() << "the trial did not end";
}

TEST(Form, IsFilledInByASimulatedPersonAndReplays) {
    Forms files;
    session::Plan plan = files.plan();
    session::sit_down(plan, person::median_person(person::Objects::device));
    const session::RunResult result = files.run(plan);
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    const CsvFile trials(result.folder + "/trials.csv");
    ASSERT_EQ(trials.rows(), 2u) << testing::read_file(result.folder + "/events.csv");
    EXPECT_EQ(trials.text(0, "sum"), "");
    EXPECT_EQ(trials.text(1, "outcome"), "filled");
    EXPECT_NEAR(trials.number(1, "sum"),
                trials.number(1, "effort") + 10 * trials.number(1, "comfort"), 1e-9);
    const std::string events = testing::read_file(result.folder + "/events.csv");
    EXPECT_NE(events.find("answer,\"comfort"), std::string::npos) << events;
    EXPECT_NE(events.find("How was it?, version 3"), std::string::npos);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

class BrokenForm : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenForm, IsRefusedWithFileLineAndRemedy) {
    Forms files;
    const Mistake& mistake = GetParam();
    const bool of_form = files.form.find(mistake.what) != std::string::npos;
    std::string& text = of_form ? files.form : files.experiment;
    const size_t at = text.find(mistake.what);
    ASSERT_NE(at, std::string::npos) << mistake.what;
    text.replace(at, std::string(mistake.what).size(), mistake.by);
    try {
        files.plan();
        ADD_FAILURE() << "no error";
    } catch (const Error& e) {
        const std::string said = e.what();
        EXPECT_NE(said.find(mistake.said), std::string::npos) << said;
        EXPECT_NE(said.find(of_form ? "form.yaml:" : "experiment.yaml:"), std::string::npos)
            << said;
    }
}
INSTANTIATE_TEST_SUITE_P(
    Mistakes, BrokenForm,
    ::testing::Values(
        Mistake{"question: 'How hard?', ", "", "question: is missing"},
        Mistake{"name: comfort", "name: effort", "is the name of another item too"},
        Mistake{"name: comfort", "name: time", "is already the quantity time"},
        Mistake{"of: effort +", "of: effrot +", "Did you mean effort?"},
        Mistake{"scale: magnitude,", "scale: vas, by: cursor,", "cannot be 'cursor' in a form"},
        Mistake{"from: -1", "from: 0.5", "is not a whole number"},
        Mistake{"items:", "itmes:", "Did you mean items?"},
        Mistake{"file: form.yaml", "file: from.yaml", "from.yaml"},
        Mistake{"file: form.yaml", "file: form.yaml, title: Mine", "together with the form itself"},
        Mistake{"file: form.yaml", "title: Mine", "the form asks nothing"},
        Mistake{"form: { file: form.yaml }",
                "form: { file: form.yaml }\n      ask: { name: a, scale: vas }",
                "together with a form"},
        Mistake{"when: answered, outcome: filled", "when: time, after_s: 9, outcome: filled",
                "do not include the form's confirmation"},
        Mistake{"optional: yes }", "optional: yes, simulated_answer: 7.123456789 }",
                "with at most 8 characters"},
        Mistake{"after_s: 5, outcome: too late }\n",
                "after_s: 5, outcome: too late }\n    - name: more\n      ask: { name: effort, "
                "scale: vas }\n      exits: [{ when: answered, outcome: more }]\n",
                "is asked on a different scale in another state"},
        Mistake{"begins: ask", "begins: aks", "Did you mean ask?"}));

}  // namespace
}  // namespace dihaptic::task::form_test
