// Five hundred synthetic people with wide parameters: no fit is above the squared error at the true
// parameters, and none of a hundred starts leads lower.
#include <gtest/gtest.h>

#include "analysis/fits/test/wide_people.h"

namespace dihaptic::analysis {
namespace {

TEST(TwoRateSoak, FiveHundredWidePeople) {
    const WideResult result = fit_wide_people(500, 100, 2028);
    EXPECT_EQ(result.above_truth, 0);
    EXPECT_LT(result.worst_start, 1e-9);
    RecordProperty("ms_a_fit", std::to_string(result.milliseconds));
}

}  // namespace
}  // namespace dihaptic::analysis
