// Tests ten minutes of play with each solver.
#include "measure/test/bars.h"
#include "measure/test/play.h"

namespace dihaptic::measure {
namespace {

class PlaySoak : public ::testing::TestWithParam<contact::Solver> {};
INSTANTIATE_TEST_SUITE_P(Solvers, PlaySoak,
                         ::testing::Values(contact::Solver::sequential_impulse,
                                           contact::Solver::stewart_trinkle,
                                           contact::Solver::staggered_projections,
                                           contact::Solver::newton),
                         solver_name);
TEST_P(PlaySoak, HarmsNothing) {
    EXPECT_GT(expect_harmless_play(GetParam(), 1, 600).held, 0);
}
TEST_P(PlaySoak, HarmsNothingWithAPoint) {
    expect_harmless_play(GetParam(), 1, 600, scene::ProxyKind::point);
}

}  // namespace
}  // namespace dihaptic::measure
