// Tests ten minutes of play with every solver.
#include "measure/test/bars.h"
#include "measure/test/play.h"

namespace dihaptic::measure {
namespace {

class PlaySoak : public ::testing::TestWithParam<dynamics::Solver> {};
INSTANTIATE_TEST_SUITE_P(Solvers, PlaySoak,
                         ::testing::Values(dynamics::Solver::sequential_impulse,
                                           dynamics::Solver::stewart_trinkle,
                                           dynamics::Solver::staggered_projections,
                                           dynamics::Solver::newton),
                         solver_name);
TEST_P(PlaySoak, HarmsNothing) {
    EXPECT_GT(expect_harmless_play(GetParam(), 1, 600).held, 0);
}
TEST_P(PlaySoak, HarmsNothingWithAPoint) {
    expect_harmless_play(GetParam(), 1, 600, scene::ProxyKind::point);
}

}  // namespace
}  // namespace dihaptic::measure
