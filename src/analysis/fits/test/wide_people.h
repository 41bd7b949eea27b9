// Compares two-rate fits of synthetic people, whose parameters cover their whole range, with the
// true parameters and with the results from random starting points.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "analysis/fits/two_rate_fit.h"
#include "base/number.h"
#include "base/random.h"

namespace dihaptic::analysis {

struct WideResult {
    int above_truth = 0;  ///< number of people for whom the fit is worse than the true parameters
    double worst_start = 0;   ///< largest relative improvement by any starting point
    double milliseconds = 0;  ///< CPU time for a fit with its intervals [ms]
};

/// Half of the people have parameters that are spread somewhat more widely than those of published
/// people; the other half come from the whole range in which learning does not diverge in growing
/// overshoots. The residuals have a standard deviation of 0.5 to 12 degrees. `starts`: number of
/// searches from random starting points.
inline WideResult fit_wide_people(int people, int starts, uint64_t seed) {
    using model::TwoRate;
    Random random(seed, "wide people");
    const auto anywhere = [&] {
        const double a = random.uniform(0, 1), b = random.uniform(0, 1);
        const double learning = std::pow(10, random.uniform(-3, 0));
        return TwoRate{{std::min(a, b), learning},
                       {std::max(a, b), learning * random.uniform(0, 1)}};
    };
    const auto as_people = [&] {
        return TwoRate{{random.uniform(0.2, 0.9), random.uniform(0.08, 0.6)},
                       {random.uniform(0.95, 1), random.uniform(0.005, 0.08)}};
    };
    std::vector<model::AdaptationTrial> trials(64);
    trials.insert(trials.end(), 160, {30});
    trials.insert(trials.end(), 16, {-30});
    trials.insert(trials.end(), 48, {0, true});
    constexpr double kFarthest = 1000;  // [degrees]
    WideResult out;
    for (int person = 0; person < people; ++person) {
        TwoRate truth = person % 2 == 0 ? as_people() : anywhere();
        std::vector<double> exact = compensation(truth, trials);
        while (std::abs(exact.back()) > kFarthest || std::abs(exact[239]) > kFarthest) {
            truth = anywhere();
            exact = compensation(truth, trials);
        }
        const double sd = random.uniform(0.5, 12);
        std::vector<double> measured = exact;
        double of_truth = 0;
        for (double& y : measured) {
            const double noise = sd * random.normal();
            y += noise;
            of_truth += noise * noise;
        }
        const std::clock_t began = std::clock();
        const TwoRateFit fit = fit_two_rate(measured, trials);
        out.milliseconds +=
            1e3 * static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC / people;
        const double squares = fit.mean_square * static_cast<double>(measured.size());
        if (squares > of_truth) ++out.above_truth;
        double least = squares_downhill(measured, trials, truth);
        for (int i = 0; i < starts; ++i)
            least = std::min(least, squares_downhill(measured, trials, anywhere()));
        out.worst_start = std::max(out.worst_start, (squares - least) / least);
    }
    return out;
}

/// Expects that no fit is worse than the true parameters or than the result from any starting
/// point.
inline void expect_least_of_all(int people, int starts, uint64_t seed) {
    const WideResult result = fit_wide_people(people, starts, seed);
    EXPECT_EQ(result.above_truth, 0);
    EXPECT_LT(result.worst_start, 1e-9);
    ::testing::Test::RecordProperty("ms_a_fit", number_text(result.milliseconds));
}

}  // namespace dihaptic::analysis
