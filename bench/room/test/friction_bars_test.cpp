// Tests the bars of the default solver and of Bullet's; a soak tests those of the other solvers.
#include "bench/test/friction_bars.h"

namespace dihaptic::bench::friction_bars_test {
namespace {

class FrictionBars : public ::testing::TestWithParam<contact::Solver> {};
INSTANTIATE_TEST_SUITE_P(Bench, FrictionBars,
                         ::testing::Values(contact::Solver::newton,
                                           contact::Solver::sequential_impulse),
                         measure::solver_name);
TEST_P(FrictionBars, AreReached) {
    expect_bars_of_friction(GetParam(),
                            bench_slides_and_piles(world_simulator(settings_of(GetParam())), {}));
}
TEST_P(FrictionBars, AHeldBlockDoesNotCreep) {
    expect_no_creep(measure_creep(settings_of(GetParam())));
}

}  // namespace
}  // namespace dihaptic::bench::friction_bars_test
