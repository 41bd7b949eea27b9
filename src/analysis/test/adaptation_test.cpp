#include "analysis/adaptation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "testing/files.h"

namespace dihaptic::analysis::adaptation_test {
namespace {

TEST(AdaptationCurves, CountTheLastAttemptOfATrial) {
    const testing::TemporaryFolder folder;
    const rows::TrialFile trials(folder.write(
        "trials.csv",
        "trial_num,attempt,round,block,kind,hand_angle_deg,shown_angle_deg,hand_extent_mm\n"
        "1,1,,learn,perturbed,40,70,\n"
        "2,1,,learn,perturbed,-10,20,\n"
        "1,2,,learn,perturbed,-12,18,\n"));
    const auto curves = adaptation_curves(trials);
    ASSERT_EQ(curves.size(), 1U);
    ASSERT_EQ(curves[0].trials.size(), 3U);
    EXPECT_TRUE(std::isnan(curves[0].trials[0].compensation));
    EXPECT_EQ(curves[0].trials[1].compensation, 10);
    EXPECT_EQ(curves[0].trials[2].compensation, 12);
    // the person saw the error nevertheless
    EXPECT_NEAR(curves[0].trials[0].perturbation, 30, 1e-9);
    EXPECT_FALSE(curves[0].trials[0].clamp);
}

}  // namespace
}  // namespace dihaptic::analysis::adaptation_test
