// Tests ratings: an answer that is typed or pointed at becomes a number of the trial, in tables and
// in formulas.
#include "task/file/rating.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/recovery.h"
#include "person/population.h"
#include "session/replay.h"
#include "session/test/reaches.h"
#include "task/test/resting_hand.h"

namespace dihaptic::task::rating_test {
namespace {

using session::Mistake;

const char* const kRating = R"(title: Rating
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  regions:
    - { name: low, position_mm: [-50, 0, 120] }
    - { name: high, position_mm: [50, 0, 120] }
  variables: [{ name: sum }]
  after_trial: [{ when: heaviness > 0, set: sum, to: sum + heaviness }]
  states:
    - name: rate
      message: How heavy was it?
      ask: { name: heaviness, scale: numbers, from: 1, to: 9, labels: [light, heavy] }
      exits:
        - { when: answered, outcome: rated }
        - { when: time, after_s: 0.5, outcome: no answer }
      simulated_hand: [{ duration_s: 0.1 }]
  blocks:
    - { name: ratings, kind: baseline, repeats: 3 }
)";

struct Ratings : session::Files {
    Ratings() { experiment = kRating; }
};

Question numbers(double least, double most, bool whole = true) {
    Question out;
    out.least = least;
    out.most = most;
    out.whole = whole;
    return out;
}

double typed(const char* keys, const Question& question) {
    Rating rating;
    for (const char* key = keys; *key != 0; ++key) rating.press(*key, question);
    return rating.answer();
}

TEST(Rating, IsTyped) {
    EXPECT_EQ(typed("7", numbers(1, 9)), 7);
    EXPECT_TRUE(std::isnan(typed("0", numbers(1, 9))));
    EXPECT_EQ(typed("05", numbers(1, 9)), 5);  // the 0 is discarded
    EXPECT_TRUE(std::isnan(typed("5", numbers(0, 100))));
    EXPECT_EQ(typed("5\r", numbers(0, 100)), 5);
    EXPECT_EQ(typed("57", numbers(0, 100)), 57);  // no further digit could follow
    EXPECT_EQ(typed("100", numbers(0, 100)), 100);
    EXPECT_EQ(typed("6\b42", numbers(0, 100)), 42);
    EXPECT_EQ(typed("2.5\r", numbers(0, 1e6, false)), 2.5);
    EXPECT_EQ(typed("2.5\r", numbers(0, 1e6)), 25);
    EXPECT_EQ(typed("-3\r", numbers(-5, 5)), -3);
    EXPECT_EQ(typed("-3", numbers(-5, 5)), -3);
    EXPECT_TRUE(std::isnan(typed("-3", numbers(-30, 5))));
    EXPECT_EQ(typed("-12", numbers(-30, 30)), -12);
    EXPECT_EQ(typed("15", numbers(12, 90)), 15);
    EXPECT_TRUE(std::isnan(typed("abc\r", numbers(0, 100))));
    EXPECT_EQ(typed("12345678901\r", numbers(0, 1e8)), 12345678);
    EXPECT_EQ(typed("72", numbers(1, 9)), 7);  // further keys are ignored
    Rating rating;
    rating.press('4', numbers(0, 100));
    EXPECT_EQ(rating.shown(), 4);
    EXPECT_TRUE(std::isnan(rating.answer()));
    rating.begin();
    EXPECT_TRUE(std::isnan(rating.shown()));
}

TEST(Rating, IsWhereTheHandIsOnALine) {
    Rating rating;
    const Vec3 from(-0.05, 0, 0.12), to(0.05, 0, 0.12);
    const Question question = numbers(0, 100, false);
    rating.point({0.02, 0.3, 0}, from, to, question);
    EXPECT_NEAR(rating.answer(), 70, 1e-9);
    rating.point({0.2, 0, 0}, from, to, question);
    EXPECT_EQ(rating.answer(), 100);
    rating.point({-0.2, 0, 0}, from, to, question);
    EXPECT_EQ(rating.answer(), 0);
    rating.point({0.021, 0, 0}, from, to, numbers(1, 9));
    EXPECT_EQ(rating.answer(), 7);
}

TEST(Rating, ByMouseIsTheFirstClickOnTheLine) {
    Question question = numbers(0, 100, false);
    question.by = AnswerBy::mouse;
    Rating rating;
    rating.begin();
    rating.click(0.25, question);
    EXPECT_NEAR(rating.answer(), 25, 1e-12);
    rating.click(0.75, question);
    EXPECT_NEAR(rating.answer(), 25, 1e-12);
    rating.begin();
    rating.click(1.5, numbers(1, 9));
    EXPECT_EQ(rating.answer(), 9);
    rating.begin();
    rating.click(0.31, numbers(1, 9));
    EXPECT_EQ(rating.answer(), 3);
}

/// Runs the director with the hand at `p_WH`, pressing the keys one after another.
std::vector<frame::TaskFrame> run(const session::Plan& plan, const std::string& keys,
                                  const Vec3& p_WH = {0, 0, 0.12}) {
    test::RestingHand hand(plan, {}, p_WH);
    std::vector<frame::TaskFrame> out;
    size_t at = 0;
    for (int i = 0; i < 20000; ++i) {
        const frame::Commands& commands = hand.tick();
        out.push_back(commands.task);
        if (commands.phase == 1 && commands.task.outcome < 0 && at < keys.size())
            hand.director.press(keys[at++]);
        if (commands.stop) break;
    }
    return out;
}

TEST(Rating, IsAVariableOfTheTrialAndANumberInItsLine) {
    Ratings files;
    const session::Plan plan = session::make_plan(files.request());
    ASSERT_EQ(plan.task->start.size(), 2u);
    std::vector<double> answers;
    std::vector<double> sums;
    for (const frame::TaskFrame& task : run(plan, "37")) {
        if (task.outcome < 0) continue;
        answers.push_back(task.variables[1].value);
        sums.push_back(task.variables[0].value);
    }
    ASSERT_EQ(answers.size(), 3u);
    EXPECT_EQ(answers[0], 3);
    EXPECT_EQ(answers[1], 7);
    EXPECT_TRUE(std::isnan(answers[2]));
    EXPECT_EQ(sums, (std::vector<double>{3, 10, 10}));
    EXPECT_NE(std::find(plan.task->messages.begin(), plan.task->messages.end(),
                        "1 light ... 9 heavy: {answer}"),
              plan.task->messages.end());
}

TEST(Rating, ByMouseIsTakenInATrialAndBetweenTrialsNot) {
    Ratings files;
    files.replace("scale: numbers, from: 1, to: 9,", "scale: vas, by: mouse,");
    const session::Plan plan = session::make_plan(files.request());
    test::RestingHand hand(plan);
    std::vector<double> answers;
    for (int i = 0; !hand.commands.stop && i < 20000; ++i) {
        const frame::Commands& commands = hand.tick();
        if (commands.task.outcome >= 0) answers.push_back(commands.task.variables[1].value);
        const bool asked = commands.phase == 1 && commands.task.outcome < 0;
        hand.director.click(Click::at(0, asked ? 0.4 : 0.9));
    }
    EXPECT_EQ(answers, (std::vector<double>{40, 40, 40}));
}

TEST(Rating, ByTheCursorIsWhereTheHandIsWhenTheStateEnds) {
    Ratings files;
    files.replace("scale: numbers, from: 1, to: 9,",
                  "scale: vas, by: cursor, between: [low, high],");
    files.replace("when: answered", "when: still, hold_s: 0.1");
    const session::Plan plan = session::make_plan(files.request());
    int trials = 0;
    for (const frame::TaskFrame& task : run(plan, "", {0.03, 0.01, 0.15})) {
        if (task.outcome < 0) continue;
        EXPECT_NEAR(task.variables[1].value, 80, 1e-9);
        EXPECT_EQ(plan.task->outcomes[static_cast<size_t>(task.outcome)].name, "rated");
        ++trials;
    }
    EXPECT_EQ(trials, 3);
}

TEST(Rating, OfASimulatedPersonIsArbitraryOnTheScaleAndSaidToBe) {
    Ratings files;
    files.replace("after_s: 0.5", "after_s: 10");
    files.replace("name: heaviness,", "name: size_mm,");
    files.replace("heaviness > 0, set: sum, to: sum + heaviness",
                  "size > 0 mm, set: sum, to: sum + 1");
    Diagnostics diagnostics;
    session::check_file(files.request().file, diagnostics);
    bool said = false;
    for (const Problem& p : diagnostics.problems())
        said = said || p.text().find("there is no model") != std::string::npos;
    EXPECT_TRUE(said);
    session::Plan plan = session::make_plan(files.request());
    session::sit_down(plan, person::median_person(person::Objects::device));
    const session::RunResult result = files.run(plan);
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    const CsvFile trials(result.folder + "/trials.csv");
    ASSERT_EQ(trials.rows(), 3u);
    EXPECT_FALSE(trials.has("next_size_mm"));
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(trials.text(i, "outcome"), "rated");
        const double size = trials.number(i, "size_mm");
        EXPECT_GE(size, 1);
        EXPECT_LE(size, 9);
        EXPECT_NEAR(size, std::round(size), 1e-9);
    }
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

TEST(Rating, OfASimulatedPersonMayBeGiven) {
    for (const char* scale :
         {"scale: numbers, from: 0, to: 1000, simulated_answer: 500",
          "scale: vas, from: -1000, to: 0, simulated_answer: -500.5",
          "scale: magnitude, simulated_answer: 123456",
          "scale: magnitude, simulated_answer: 0.00001",
          "scale: likert, from: -2, labels: [a, b, c, d, e], simulated_answer: -1"}) {
        SCOPED_TRACE(scale);
        Ratings files;
        files.replace("after_s: 0.5", "after_s: 10");
        files.replace("scale: numbers, from: 1, to: 9, labels: [light, heavy]", scale);
        session::Plan plan = session::make_plan(files.request());
        session::sit_down(plan, person::median_person(person::Objects::device));
        const session::RunResult result = files.run(plan);
        analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
        const CsvFile trials(result.folder + "/trials.csv");
        const double given = plan.task->task.states[0].ask->simulated.value();
        for (size_t i = 0; i < 3; ++i) EXPECT_EQ(trials.number(i, "heaviness"), given);
    }
}

class BrokenRating : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenRating, IsRefusedWithFileLineAndRemedy) {
    Ratings files;
    session::expect_refused(files, GetParam());
}
INSTANTIATE_TEST_SUITE_P(
    Mistakes, BrokenRating,
    ::testing::Values(
        Mistake{"name: heaviness, ", "", "name: is missing"},
        Mistake{"name: heaviness", "name: high", "is already the quantity high"},
        Mistake{"name: heaviness", "name: how heavy", "cannot be used in a formula"},
        Mistake{"name: heaviness", "name: outcome", "is already the quantity outcome"},
        Mistake{"scale: numbers, ", "", "scale: is missing"},
        Mistake{"scale: numbers", "scale: number", "is not known"},
        Mistake{"from: 1, ", "", "from: is missing"},
        Mistake{"to: 9", "to: 1", "must be above 'from', which is 1"},
        Mistake{"to: 9", "to: nine", "must be a number"},
        Mistake{"labels: [light, heavy]", "labels: [light, middle, heavy]", "a scale has two ends"},
        Mistake{"scale: numbers,", "scale: likert,", "as many numbers as labels"},
        Mistake{"scale: numbers, from: 1, to: 9, labels: [light, heavy]",
                "scale: likert, labels: [one]", "2 to 9"},
        Mistake{"scale: numbers, from: 1", "scale: magnitude, from: -1", "a magnitude cannot be"},
        Mistake{"labels: [light", "by: cursor, labels: [light",
                "the line needs a region at each end"},
        Mistake{"labels: [light", "by: eye, labels: [light", "by"},
        Mistake{"labels: [light", "by: cursor, between: [low, hihg], labels: [light",
                "Did you mean high?"},
        Mistake{"labels: [light", "by: cursor, between: [low, high], labels: [light",
                "is available at all times"},
        Mistake{"labels: [light", "between: [low, high], labels: [light",
                "cannot be used with 'by: key'"},
        Mistake{"scale: numbers, from: 1, to: 9, labels: [light, heavy]",
                "scale: magnitude, by: cursor, between: [low, high]", "no upper limit"},
        Mistake{"      ask: { name: heaviness, scale: numbers, from: 1, to: 9, labels: [light, "
                "heavy] }\n",
                "", "does not ask for a number"},
        Mistake{"when: answered,", "when: answered, hold_s: 1,", "an answer has no duration"},
        Mistake{"when: answered,", "when: answered, count: 2,", "count"},
        Mistake{"      ask:", "      lines: [a, b]\n      ask:", "at most 2 are allowed"}));

}  // namespace
}  // namespace dihaptic::task::rating_test
