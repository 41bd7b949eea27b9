// Fits five hundred synthetic people with parameters from a wide range. No fit may have a larger
// squared error than the true parameters, and no search from one of a hundred starting points may
// find a smaller error.
#include <gtest/gtest.h>

#include "analysis/fits/test/wide_people.h"

namespace dihaptic::analysis {
namespace {

TEST(TwoRateSoak, FiveHundredWidePeople) {
    expect_least_of_all(500, 100, 2028);
}

}  // namespace
}  // namespace dihaptic::analysis
