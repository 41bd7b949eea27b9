// Tests that the two-rate fit is globally optimal: no worse than the true parameters, than the
// result from any starting point, and than published fits of 32 people.
#include "analysis/fits/two_rate_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/fits/test/wide_people.h"
#include "base/table.h"
#include "testing/files.h"

namespace dihaptic::analysis::two_rate_fit_test {
namespace {

TEST(TwoRateFit, IsTheLeastOfAllStarts) {
    expect_least_of_all(12, 60, 1);
}

TEST(TwoRateFit, OfAForgottenNothingAndALearnedNothing) {
    const std::vector<model::AdaptationTrial> trials(40, {30});
    const TwoRateFit still = fit_two_rate(std::vector<double>(40, 0.0), trials);
    EXPECT_NEAR(still.mean_square, 0, 1e-12);
    // the perturbation is learned at once and never forgotten
    std::vector<double> step(40, 30.0);
    step[0] = 0;
    EXPECT_NEAR(fit_two_rate(step, trials).mean_square, 0, 1e-12);
}

/// Active reaches of 32 people, and the fits that were published for them (github.com,
/// JennR1990/TwoRateProprioception: Published-data/active_reaches.csv and ana/AICs/Two Rate
/// Parameters for Active Reaches.csv).
TEST(TwoRateFit, ReproducesOrBettersThePublishedFitsOf32People) {
    DIHAPTIC_NEEDS_DATA(reaches, "two-rate/active_reaches.csv");
    DIHAPTIC_NEEDS_DATA(published, "two-rate/Two Rate Parameters for Active Reaches.csv");
    const CsvFile all(reaches);
    const CsvFile fits(published);
    ASSERT_EQ(fits.rows(), 32u);
    for (size_t p = 0; p < fits.rows(); ++p) {
        const std::string who = fits.text(p, "participant");
        std::vector<model::AdaptationTrial> trials;
        std::vector<double> measured;
        for (size_t i = 0; i < all.rows(); ++i) {
            const double f = all.number(i, "distortion");  // NA stands for an error clamp
            trials.push_back({std::isnan(f) ? 0 : f, std::isnan(f)});
            measured.push_back(-all.number(i, who));
        }
        const TwoRateFit fit = fit_two_rate(measured, trials);
        EXPECT_LE(fit.mean_square, fits.number(p, "MSE") * (1 + 1e-9)) << who;
    }
}

}  // namespace
}  // namespace dihaptic::analysis::two_rate_fit_test
