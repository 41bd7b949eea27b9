// The bars of the solvers that src/measure/test/bars_test.cpp leaves out.
#include "measure/test/bars.h"

namespace dihaptic::measure {
namespace {

class GraspBars : public ::testing::TestWithParam<dynamics::Solver> {};
INSTANTIATE_TEST_SUITE_P(Soak, GraspBars,
                         ::testing::Values(dynamics::Solver::stewart_trinkle,
                                           dynamics::Solver::staggered_projections),
                         solver_name);
TEST_P(GraspBars, AreReached) {
    expect_bars_of_grasp(GetParam());
}

class FrictionBars : public ::testing::TestWithParam<dynamics::Solver> {};
INSTANTIATE_TEST_SUITE_P(Soak, FrictionBars,
                         ::testing::Values(dynamics::Solver::stewart_trinkle,
                                           dynamics::Solver::staggered_projections),
                         solver_name);
TEST_P(FrictionBars, AreReached) {
    expect_bars_of_friction(GetParam());
}

}  // namespace
}  // namespace dihaptic::measure
