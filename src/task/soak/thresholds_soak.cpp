// Measures the precision of the thresholds in experiments/visual-scaling.yaml. The staircases of
// this experiment are run on two hundred observers who judge a ratio of lengths with noise, and
// their answers are fitted as in the report. The results are in analysis/fits/README.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/fits/psychometric_fit.h"
#include "base/random.h"
#include "task/file/experiment.h"
#include "task/file/procedure_spec.h"

namespace dihaptic::task {
namespace {

/// An observer who answers "more" if the logarithm of the ratio plus noise is positive, and who
/// sometimes lapses.
struct Observer {
    double sd;
    static constexpr double kLapse = 0.015;

    /// Probability of a correct answer when `scale` is shown with this share.
    double right(double scale, double share) const {
        const double ratio = std::abs(std::log(1 + share * (scale - 1)));
        return kLapse + (1 - 2 * kLapse) * 0.5 * std::erfc(-ratio / sd / std::sqrt(2.0));
    }
    /// Share at which three out of four answers would be correct if there were no lapses.
    double threshold(double scale) const {
        return std::abs(std::exp((scale > 1 ? 1 : -1) * 0.6744897501960817 * sd) - 1) /
               std::abs(scale - 1);
    }
};

TEST(Thresholds, OfTwentyFiveAnswersAreRough) {
    Diagnostics diagnostics;
    const Experiment experiment = read_experiment("experiments/visual-scaling.yaml", diagnostics);
    diagnostics.throw_if_errors();
    Random random(11, "scaling");
    constexpr int kObservers = 200;
    double bias = 0;
    double square = 0;
    int held = 0;
    for (int i = 0; i < kObservers; ++i) {
        // distributed as in adults.yaml
        const Observer observer{0.12 * std::exp(0.25 * random.normal())};
        const ProcedureSpec& spec = experiment.task->procedures[static_cast<size_t>(i % 2)];
        const double scale = i % 2 == 0 ? 2 : 0.5;
        Procedure procedure = make_procedure(spec, 0);
        std::vector<analysis::Answer> answers;
        while (!procedure.done()) {
            const double level = procedure.level();
            const bool yes = random.uniform(0, 1) < observer.right(scale, spec.share(level));
            answers.push_back({level, yes});
            procedure.answer(level, yes);
        }
        const analysis::PsychometricFitSettings settings{.sigmoid = spec.fitted(),
                                                         .guess = spec.guess};
        const auto counts = analysis::count(answers);
        const auto fit = analysis::fit_psychometric(counts, settings);
        const auto interval = analysis::profile_intervals(counts, fit, settings).threshold;
        const double truth = observer.threshold(scale);
        const double error = fit.function.threshold - truth;
        bias += error / truth / kObservers;
        square += error * error / truth / truth / kObservers;
        held += interval.low <= truth && truth <= interval.high ? 1 : 0;
    }
    const double coverage = static_cast<double>(held) / kObservers;
    fmt::print(
        "bias {:.2f} and rms error {:.2f} of the threshold; intervals contain it in {:.2f}\n", bias,
        std::sqrt(square), coverage);
    // the README describes the thresholds as rough; if they improve, it must be updated
    EXPECT_GT(std::sqrt(square), 0.5);
    EXPECT_LT(std::sqrt(square), 5);
    EXPECT_GT(coverage, 0.7);
    EXPECT_LT(coverage, 0.95);
}

}  // namespace
}  // namespace dihaptic::task
