// Tests procedures and fits on two hundred simulated observers: the estimates must be unbiased, and
// the intervals must contain the true threshold as often as they claim.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/fits/psychometric_fit.h"
#include "base/number.h"
#include "base/random.h"
#include "task/procedures/procedure.h"

namespace dihaptic::task::observers_test {
namespace {

constexpr int kObservers = 200;

std::vector<double> grid(double first, double last, double step) {
    std::vector<double> values;
    for (int i = 0; first + i * step < last + step / 2; ++i) values.push_back(first + i * step);
    return values;
}

/// Errors of an estimate over all observers, in units of the SD of their psychometric functions.
struct Judge {
    const char* name;
    double bias = 0;
    double square = 0;
    int held = 0;

    void add(const model::Psychometric& truth, double estimate, double low, double high) {
        const double error = (estimate - truth.threshold) / truth.sd();
        bias += error / kObservers;
        square += error * error / kObservers;
        held += low <= truth.threshold && truth.threshold <= high ? 1 : 0;
    }
    void check() const {
        const double coverage = static_cast<double>(held) / kObservers;
        testing::Test::RecordProperty(std::string(name) + "_bias", number_text(bias));
        testing::Test::RecordProperty(std::string(name) + "_rms", number_text(std::sqrt(square)));
        testing::Test::RecordProperty(std::string(name) + "_coverage", number_text(coverage));
        EXPECT_LT(std::abs(bias), 0.1) << name;
        EXPECT_GE(coverage, 0.90) << name;
        EXPECT_LE(coverage, 0.98) << name;
    }
};

/// Returns a random observer who chooses between two alternatives and sometimes lapses.
model::Psychometric observer(Random& random) {
    return {model::Sigmoid::normal, random.uniform(1, 3), random.uniform(0.7, 1.4), 0.5, 0.02};
}

std::vector<analysis::Answer> run(Procedure& procedure, const model::Psychometric& truth,
                                  Random& random) {
    std::vector<analysis::Answer> answers;
    while (!procedure.done()) {
        const double x = procedure.level();
        answers.push_back({x, random.uniform(0, 1) < truth.probability(x)});
        procedure.answer(x, answers.back().yes);
    }
    return answers;
}

TEST(Observers, StaircasesFittedByMaximumLikelihood) {
    Random random(1, "observers");
    Judge fitted{"fit"};
    double reversal_bias = 0;
    for (int i = 0; i < kObservers; ++i) {
        const model::Psychometric truth = observer(random);
        Procedure staircase(Staircase({.down_after = 2,
                                       .start = 5,
                                       .steps_up = {2, 1, 0.6},
                                       .down_over_up = 0.5,
                                       .lowest = -2,
                                       .highest = 6,
                                       .trials = 240,
                                       .skipped_reversals = 6}));
        const auto counts = analysis::count(run(staircase, truth, random));
        const analysis::PsychometricFitSettings settings;
        const auto fit = analysis::fit_psychometric(counts, settings);
        const auto interval = analysis::profile_intervals(counts, fit, settings).threshold;
        fitted.add(truth, fit.function.threshold, interval.low, interval.high);
        const double settles = truth.level(settling_probability(2, 0.5));
        reversal_bias += (staircase.estimate().threshold - settles) / truth.sd() / kObservers;
    }
    fitted.check();
    RecordProperty("reversal_bias", number_text(reversal_bias));
    EXPECT_LT(std::abs(reversal_bias), 0.1);
}

TEST(Observers, QuestPlus) {
    Random random(2, "observers");
    Judge threshold{"quest_plus"};
    const QuestPlus fresh({.sigmoid = model::Sigmoid::normal,
                           .levels = grid(-2, 6, 0.5),
                           .thresholds = grid(-1, 5, 0.1),
                           .shapes = {0.4, 0.6, 0.8, 1, 1.2, 1.5, 1.9},
                           .lapses = {0, 0.02, 0.04},
                           .trials = 120});
    for (int i = 0; i < kObservers; ++i) {
        const model::Psychometric truth = observer(random);
        Procedure procedure(fresh);
        run(procedure, truth, random);
        const Estimate e = procedure.estimate();
        threshold.add(truth, e.threshold, e.low, e.high);
    }
    threshold.check();
}

TEST(Observers, Quest) {
    Random random(3, "observers");
    Judge threshold{"quest"};
    for (int i = 0; i < kObservers; ++i) {
        // a Weibull function with the slope that QUEST assumes, and with its threshold at 82 %
        model::Psychometric truth{model::Sigmoid::weibull_log10, random.uniform(-1.5, -0.5), 3.5,
                                  0.5, 0.005};
        Procedure procedure(Quest({.prior_mean = -1, .prior_sd = 1, .trials = 60}));
        run(procedure, truth, random);
        const Estimate e = procedure.estimate();
        const double shift = truth.level(0.82) - truth.threshold;
        threshold.add(truth, e.threshold - shift, e.low - shift, e.high - shift);
    }
    threshold.check();
}

}  // namespace
}  // namespace dihaptic::task::observers_test
