#include <gtest/gtest.h>

#include "person/traits.h"
#include "testing/bounds.h"

namespace dihaptic::person::bounds_test {
namespace {

TEST(Bounds, AreOfEveryTrait) {
    testing::BoundsFinder finder;
    Traits traits;
    finder("", traits);
    EXPECT_GT(finder.numbers, 30);
    for (const std::string& path : finder.unbounded) ADD_FAILURE() << path << " lacks a bound";
}

}  // namespace
}  // namespace dihaptic::person::bounds_test
