// Tests the friction acceptance limits of those solvers that friction_bars_test.cpp leaves out.
#include "bench/test/friction_bars.h"

namespace dihaptic::bench {
namespace {

class FrictionBars : public ::testing::TestWithParam<contact::Solver> {};
INSTANTIATE_TEST_SUITE_P(Soak, FrictionBars,
                         ::testing::Values(contact::Solver::stewart_trinkle,
                                           contact::Solver::staggered_projections),
                         measure::solver_name);
TEST_P(FrictionBars, AreReached) {
    const FrictionFigures figures = bench_friction(settings_of(GetParam()), {});
    expect_bars_of_friction(GetParam(), figures);
    expect_no_creep(figures.creep_mm.value());
}

}  // namespace
}  // namespace dihaptic::bench
