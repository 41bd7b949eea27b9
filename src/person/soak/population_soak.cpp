// Tests the shipped population in the whole program, on a schedule that four of the groups did to
// which its rates were calibrated: that of TwoRateProprioception (64 baseline trials, 160 at 30
// degrees, 16 reversed, 48 clamped). Compares means and standard deviations over simulated people
// with those of the four groups of 32 people. README.md discusses the result.
#include <fmt/format.h>

#include <array>

#include "analysis/adaptation.h"
#include "base/statistics.h"
#include "person/test/reaches.h"

namespace dihaptic::person {
namespace {

struct Figure {
    const char* what;
    size_t from;
    size_t to;
    double mean;  ///< mean over the four groups [degrees]
    double sd;    ///< standard deviation over the people of a group [degrees]
};
constexpr std::array kFigures{Figure{"trials 1 to 8", 64, 72, 15.4, 4.0},
                              Figure{"9 to 24", 72, 88, 23.5, 3.9},
                              Figure{"25 to 64", 88, 128, 25.0, 3.7},
                              Figure{"last 32", 192, 224, 27.9, 4.2},
                              Figure{"last 4 of the reversal", 236, 240, -8.7, 9.1},
                              Figure{"9 to 24 of the clamp", 248, 264, 7.5, 8.1},
                              Figure{"last 24 of the clamp", 264, 288, 6.7, 7.6}};
constexpr double kClose = 3;       // largest permitted difference of means [degrees]
constexpr double kAsSpread = 0.3;  // largest permitted difference of SDs, as a share

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value / static_cast<double>(values.size());
    return sum;
}

double deviation(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += std::pow(value - mean(values), 2);
    return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

/// The values of the trials in [from, to), except for trials that were given up.
std::vector<double> done(const std::vector<double>& hand, size_t from, size_t to) {
    std::vector<double> out;
    for (size_t n = from; n < to; ++n) {
        if (!std::isnan(hand[n])) out.push_back(hand[n]);
    }
    return out;
}

struct People {
    std::array<std::vector<double>, kFigures.size()> figures;
    std::vector<double> baseline_sd;  // for each person, over the baseline trials
    std::vector<analysis::TwoRateFit> fits;
};

People population(int people, bool adapts) {
    Sitting sitting("rotation-reversal");
    People out;
    for (int i = 1; i <= people; ++i) {
        session::Plan plan = sitting.plan();
        Traits traits = draw_person(Objects::device, 1, fmt::format("sim-{:03d}", i));
        if (!adapts) traits.fast_learning = traits.slow_learning = 0;
        sit_down(plan, traits);
        const Curve curve = reaches(plan);
        const double base = mean(done(curve.hand, 0, 64));
        for (size_t f = 0; f < kFigures.size(); ++f) {
            const auto values = done(curve.hand, kFigures[f].from, kFigures[f].to);
            if (!values.empty()) out.figures[f].push_back(mean(values) - base);
        }
        out.baseline_sd.push_back(deviation(done(curve.hand, 0, 64)));
        if (adapts) out.fits.push_back(analysis::fit_two_rate(curve.hand, schedule(plan)));
    }
    return out;
}

TEST(Population, OfTwoHundredAdaptsAndDiffersAsPeopleDo) {
    const People people = population(200, true);
    for (size_t f = 0; f < kFigures.size(); ++f) {
        const double m = mean(people.figures[f]);
        const double sd = deviation(people.figures[f]);
        fmt::print("{:22s} {:6.1f} (SD {:4.1f})   people {:6.1f} (SD {:4.1f})\n", kFigures[f].what,
                   m, sd, kFigures[f].mean, kFigures[f].sd);
        EXPECT_NEAR(m, kFigures[f].mean, kClose) << kFigures[f].what;
        EXPECT_NEAR(sd, kFigures[f].sd, kAsSpread * kFigures[f].sd) << kFigures[f].what;
    }
    // printed but not tested, because fits determine the parameters of people poorly, too
    const auto quartiles = [&](const char* what, auto value, const char* published) {
        std::vector<double> all;
        for (const analysis::TwoRateFit& fit : people.fits) all.push_back(value(fit));
        std::sort(all.begin(), all.end());
        fmt::print("{:22s} median {:.3f}, quartiles {:.3f} to {:.3f}   people {}\n", what,
                   all[all.size() / 2], all[all.size() / 4], all[3 * all.size() / 4], published);
    };
    quartiles(
        "fit: slow retention", [&](const auto& f) { return f.rates.slow.retention; },
        "0.9995, 0.991 to 1");
    quartiles(
        "fit: slow learning", [&](const auto& f) { return f.rates.slow.learning; },
        "0.033, 0.026 to 0.056");
    quartiles(
        "fit: fast retention", [&](const auto& f) { return f.rates.fast.retention; },
        "0.635, 0.54 to 0.73");
    quartiles(
        "fit: fast learning", [&](const auto& f) { return f.rates.fast.learning; },
        "0.242, 0.17 to 0.49");
    quartiles(
        "fit: residual SD [deg]", [](const auto& f) { return f.residual_sd; }, "6.6");
    fmt::print("SD of baseline trials, median {:.2f} degrees; people 4.4\n",
               quantile(people.baseline_sd, 0.5));
}

TEST(Population, WithoutAdaptationDoesNot) {
    const People people = population(10, false);
    int far = 0;
    for (size_t f = 0; f < kFigures.size(); ++f)
        far += std::abs(mean(people.figures[f]) - kFigures[f].mean) > kClose ? 1 : 0;
    EXPECT_GE(far, 5);
}

}  // namespace
}  // namespace dihaptic::person
