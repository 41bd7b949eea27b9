#include "base/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dihaptic::statistics_test {
namespace {

TEST(Quantile, IsTheValueAtTheNearestPlace) {
    const std::vector<double> odd{5, 1, 3, 2, 4};
    EXPECT_EQ(quantile(odd, 0), 1);
    EXPECT_EQ(quantile(odd, 0.5), 3);
    EXPECT_EQ(quantile(odd, 0.7), 4);
    EXPECT_EQ(quantile(odd, 1), 5);
    EXPECT_EQ(quantile(std::vector<float>{4, 1, 3, 2}, 0.5), 3);
    EXPECT_TRUE(std::isnan(quantile(std::vector<double>{}, 0.5)));
}

}  // namespace
}  // namespace dihaptic::statistics_test
