#include "task/procedures/quest_plus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/diagnostics.h"
#include "base/random.h"

namespace dihaptic::task::quest_plus_test {
namespace {

std::vector<double> range(double first, double last, double step = 1) {
    std::vector<double> values;
    for (int i = 0; first + i * step < last + step / 2; ++i) values.push_back(first + i * step);
    return values;
}

/// Gives the answers ('C' for correct), and checks that the level of each trial is the one in the
/// paper.
void expect_run(QuestPlus& quest, const std::vector<double>& placements,
                const std::string& answers) {
    ASSERT_EQ(placements.size(), answers.size());
    for (size_t i = 0; i < answers.size(); ++i) {
        ASSERT_NEAR(quest.level(), placements[i], 1e-12) << "trial " << i;
        quest.answer(quest.level(), answers[i] == 'C');
    }
}

/// Returns settings for contrast in dB, as in the paper. The paper's slopes refer to levels / 20,
/// whereas ours refer to levels.
QuestPlusSettings contrast(std::vector<double> slopes_per_20_db, std::vector<double> lapses) {
    for (double& s : slopes_per_20_db) s /= 20;
    return {.levels = range(-40, 0),
            .thresholds = range(-40, 0),
            .shapes = std::move(slopes_per_20_db),
            .lapses = std::move(lapses),
            .trials = 200};
}

// The runs of the examples in Watson (2017), trial by trial, and the modes at the end of each run.

TEST(QuestPlus, RepeatsWatsonsRunForThreshold) {
    QuestPlus quest(contrast({3.5}, {0.02}));
    expect_run(quest,
               {-18, -22, -25, -28, -30, -22, -13, -15, -16, -18, -19, -20, -21, -22, -23, -19,
                -20, -20, -18, -18, -19, -17, -17, -18, -18, -18, -19, -19, -19, -19, -19, -19},
               "CCCCIICCCCCCCCICCICCICCCCCCCCCCC");
    EXPECT_EQ(quest.mode().threshold, -20);
}

TEST(QuestPlus, RepeatsWatsonsRunForThresholdAndSlope) {
    QuestPlus quest(contrast(range(2, 5), {0.02}));
    expect_run(quest,
               {-18, -22, -12, -13, -15, -16, -17, -18, -19, -21, -24, -25, -26, -27, -21, -22,
                -23, -20, -20, -20, -21, -19, -19, -20, -20, -20, -19, -19, -19, -19, -19, -20,
                -20, -20, -20, -20, -21, -21, -20, -20, -20, -19, -18, -18, -19, -19, -19, -18,
                -18, -17, -18, -18, -18, -17, -17, -17, -17, -17, -17, -17, -18, -18, -18, -18},
               "CICCCCCCCCCCCICCICCCICCCCICCCCCCCCCCCICCIICCCCICICCCICCCCCCCCCCC");
    EXPECT_EQ(quest.mode().threshold, -20);
    EXPECT_NEAR(20 * quest.mode().shape, 3, 1e-12);
}

TEST(QuestPlus, RepeatsWatsonsRunForThresholdSlopeAndLapse) {
    QuestPlus quest(contrast(range(2, 5), range(0, 0.04, 0.01)));
    expect_run(quest,
               {-18, -22, -25, -28, -30, -21, -12, -14, -15, -16, -18, -19, -20, -22, -23, -18,
                -19, -16, -17, -17, -18, -18, -18, -19, -19, -17, -17, -18, -18, -18, -18, -19,
                -19, -20, -18, -18, -18, -18, -18, -19, -19, -19, -19, -20, -18, -18, -18, -18,
                -18, -18, -18, -18, -18, -19, -19, -19, -20, -18, -18, -18, -18, -19, -19, -19,
                -18, -18, -18, -18, -19, -19, -19, -19, -19, -19, -19, -19, -20, -21, -19, -19,
                -19, -19, -19, -19, -19, -18, -19, -19, -16, -16, -16, -16, -16, -16, 0,   0,
                -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -21, -21,
                -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19},
               "CCCCIICCCCCCCCICICCCCCCCICCCCCCCCICCCCCCCCCICCCICCCCCCCCICCCCCCIC"
               "CCCCCCCCCCCCICICCCCICCICCCCCCCICCCCCCCCCCCCCCCICCCICIICCCCICCCC");
    EXPECT_EQ(quest.mode().threshold, -20);
    EXPECT_NEAR(20 * quest.mode().shape, 5, 1e-12);
    EXPECT_NEAR(quest.mode().lapse, 0.04, 1e-12);
}

TEST(QuestPlus, RepeatsWatsonsRunForMeanSpreadAndLapse) {
    QuestPlus quest({.sigmoid = model::Sigmoid::normal,
                     .levels = range(-10, 10),
                     .thresholds = range(-5, 5),
                     .shapes = range(1, 10),
                     .lapses = range(0, 0.04, 0.01),
                     .guess_is_lapse = true,
                     .trials = 200});
    expect_run(quest, {0,  -1, 2,  -2, 2,  3,  3,  -5, 3,  3,  3,  3,  -7, -7, -7, -7, 4,  -7, 4,
                       4,  4,  -8, -8, -8, 4,  -8, 4,  -8, -7, 4,  -7, -7, 4,  -7, 4,  -7, -6, 3,
                       -4, -5, 3,  3,  -7, 2,  2,  1,  0,  -7, -6, -6, -6, 2,  -5, 2,  -6, -5, 3,
                       -5, -5, 3,  4,  -5, -5, 4,  -4, -4, -4, -4, 4,  3,  3,  4,  5,  5,  -5, 5,
                       -5, -5, 4,  5,  5,  -5, -4, -4, -4, -4, 5,  -4, -4, -3, 4,  4,  5,  5,  -4,
                       5,  -4, -4, 5,  4,  5,  5,  -5, 5,  -4, -4, -4, -4, 5,  -4, 5,  4,  -4, 4,
                       -4, -4, -4, 4,  -4, -4, -4, 4,  4,  -4, 4,  4,  4,  -4},
               "CIICCCCCCCICIIIICCICCIIICICIICIICICIICICCCICCCIIIIICIIIICIIICIIC"
               "IIICCCIICCICIIICCIIIIICIICCICCICICCICCICIIIICCCCICIIICIIIICCCCCI");
    EXPECT_EQ(quest.mode().threshold, 0);
    EXPECT_EQ(quest.mode().shape, 4);
    EXPECT_NEAR(quest.mode().lapse, 0.01, 1e-12);
}

TEST(QuestPlus, ExpectedEntropyIsThatOfThePosteriorsOfBothAnswers) {
    QuestPlus quest(contrast(range(2, 5), range(0, 0.04, 0.01)));
    const std::string answers = "CCICICCCIC";
    for (const char answer : answers) {
        for (size_t i = 0; i < quest.settings().levels.size(); i += 5) {
            double expected = 0;
            for (const bool yes : {true, false}) {
                QuestPlus after = quest;
                // probability of this answer by definition, i.e. the sum of prior times likelihood
                double share = 0;
                size_t cell = 0;
                for (const double t : quest.settings().thresholds)
                    for (const double s : quest.settings().shapes)
                        for (const double lapse : quest.settings().lapses) {
                            const double x = quest.settings().levels[i];
                            const double p =
                                1 - lapse -
                                (1 - 0.5 - lapse) * std::exp(-std::pow(10, s * (x - t)));
                            share += quest.posterior()[cell++] * (yes ? p : 1 - p);
                        }
                after.answer(quest.settings().levels[i], yes);
                double entropy = 0;
                for (const double w : after.posterior())
                    if (w > 0) entropy -= w * std::log(w);
                expected += share * entropy;
            }
            EXPECT_NEAR(quest.expected_entropy(i), expected, 1e-9);
        }
        quest.answer(quest.level(), answer == 'C');
    }
}

TEST(QuestPlus, RecoversAnObserver) {
    const model::Psychometric observer{model::Sigmoid::weibull_log10, -1.02, 3, 0.5, 0.03};
    Random random(3, "observer");
    QuestPlus quest({.levels = range(-2, 0, 0.05),
                     .thresholds = range(-2, 0, 0.05),
                     .shapes = range(1, 6, 0.5),
                     .lapses = range(0, 0.08, 0.01),
                     .trials = 1500});
    while (!quest.done()) {
        const double x = quest.level();
        quest.answer(x, random.uniform(0, 1) < observer.probability(x));
    }
    EXPECT_NEAR(quest.mean().threshold, -1.02, 0.03);
    EXPECT_NEAR(quest.mean().shape, 3, 0.6);
    EXPECT_NEAR(quest.mean().lapse, 0.03, 0.015);
    EXPECT_LT(quest.estimate().low, -1.02);
    EXPECT_GT(quest.estimate().high, -1.02);
}

TEST(QuestPlus, AnswersOffTheGridCountWhereTheyWere) {
    QuestPlus between(contrast({3.5}, {0.02})), at(contrast({3.5}, {0.02}));
    between.answer(-20.5, true);
    at.answer(-20, true);
    EXPECT_NE(between.posterior(), at.posterior());
    double sum = 0;
    for (const double w : between.posterior()) sum += w;
    EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(QuestPlus, SurvivesAnswersThatItsGridHoldsImpossible) {
    QuestPlus quest({.sigmoid = model::Sigmoid::normal,
                     .levels = {-100, 0, 100},
                     .thresholds = {-1, 0, 1},
                     .shapes = {0.1},
                     .lapses = {0},
                     .guess = 0,
                     .trials = 10});
    quest.answer(100, false);
    quest.answer(-100, true);
    EXPECT_NEAR(quest.estimate().threshold, 0, 1e-9);
}

TEST(QuestPlus, RefusesSettingsThatMeanNothing) {
    const auto good = contrast({3.5}, {0.02});
    const auto refused = [&](auto&& change) {
        QuestPlusSettings s = good;
        change(s);
        EXPECT_THROW(QuestPlus{s}, Error);
    };
    refused([](auto& s) { s.levels.clear(); });
    refused([](auto& s) { s.levels = {2, 1}; });
    refused([](auto& s) { s.thresholds = {NAN}; });
    refused([](auto& s) { s.shapes = {0, 1}; });
    refused([](auto& s) { s.lapses = {-0.01}; });
    refused([](auto& s) { s.lapses = {0.1}, s.guess = 0.95; });
    refused([](auto& s) { s.guess = -1; });
    refused([](auto& s) { s.trials = 0; });
    refused([](auto& s) { s.sigmoid = model::Sigmoid::weibull; });
}

}  // namespace
}  // namespace dihaptic::task::quest_plus_test
