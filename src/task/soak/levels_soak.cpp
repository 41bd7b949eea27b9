// Measures how often the interval in the report contains the threshold of observers with known
// psychometric functions in a two-interval discrimination task, for each kind of procedure.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/thresholds.h"
#include "task/test/observer.h"

namespace dihaptic::task {
namespace {

struct Case {
    const char* name;
    const char* procedure;
    model::Psychometric observer;
    /// Whether the observer matches the procedure's assumptions. If not, intervals may be too wide.
    bool as_taken = true;
};

constexpr model::Psychometric kNormal{model::Sigmoid::normal, 0.35, 0.12, 0.5, 0};
/// The psychometric function that QUEST assumes for the logarithm of the level, expressed in terms
/// of the level itself.
constexpr model::Psychometric kWeibull{model::Sigmoid::weibull, 0.35, 3.5, 0.5, 0};
constexpr model::Psychometric kFlat{model::Sigmoid::weibull, 0.35, 2.5, 0.5, 0};
constexpr model::Psychometric kSteep{model::Sigmoid::weibull, 0.35, 5, 0.5, 0};
constexpr const char* kQuest =
    "trials: 240\n      logarithmic: yes\n      quest: { prior_mean: -0.5, prior_sd: 0.5, lowest: "
    "-2, highest: 0 }";

const Case kCases[] = {
    {"constant",
     "trials: 240\n      constant: { levels: [0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75] }",
     kNormal},
    {"staircase",
     "trials: 240\n      staircase: { start: 0.8, lowest: 0, highest: 1, steps_up: [0.2, 0.1], "
     "down_after: 2, down_over_up: 0.5488 }",
     kNormal},
    {"quest", kQuest, kWeibull},
    {"quest, on a flatter function", kQuest, kFlat, false},
    {"quest, on a steeper function", kQuest, kSteep, false},
    {"quest_plus",
     "trials: 240\n      quest_plus: { levels: { from: 0.02, to: 1, count: 50 }, thresholds: { "
     "from: 0.05, to: 0.9, count: 35 }, shapes: { from: 0.04, to: 0.3, count: 8 } }",
     kNormal},
};

TEST(Levels, ThresholdsLieInTheirIntervals) {
    constexpr int kRuns = 400;
    constexpr uint64_t kFirstSeed = 20001;
    for (const Case& c : kCases) {
        int held = 0;
        double bias = 0;
        for (uint64_t run = 0; run < kRuns; ++run) {
            test::Intervals files(c.procedure);
            const session::Plan plan = session::make_plan(files.request(kFirstSeed + run));
            const ProcedureSpec& spec = plan.task->task.procedures.front();
            Random random(kFirstSeed + run, c.name);
            analysis::ThresholdTrack track;
            track.logarithmic = spec.logarithmic;
            track.model.sigmoid = spec.fitted();
            track.model.shape = spec.known_shape();
            track.model.guess = spec.guess;
            for (const test::IntervalTrial& trial : test::observe(plan, c.observer, random))
                track.answers.push_back({spec.logarithmic ? std::log10(trial.level) : trial.level,
                                         trial.chose_comparison});
            const analysis::ThresholdFit fit = analysis::fit_threshold(track);
            if (!fit.fit) continue;
            const auto interval = analysis::threshold_intervals(track, *fit.fit).threshold;
            const double truth = c.observer.threshold;
            held += track.share(interval.low) <= truth && truth <= track.share(interval.high);
            bias += (track.share(fit.fit->function.threshold) - truth) / truth / kRuns;
        }
        fmt::print("{}: threshold in {} of {} intervals, bias {:.3f} of the threshold\n", c.name,
                   held, kRuns, bias);
        EXPECT_GE(held, 0.90 * kRuns) << c.name;
        if (c.as_taken) {
            EXPECT_LE(held, 0.98 * kRuns) << c.name;
        }
    }
}

}  // namespace
}  // namespace dihaptic::task
