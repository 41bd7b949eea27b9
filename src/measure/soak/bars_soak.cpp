// Tests the bars of those solvers that src/measure/test/bars_test.cpp leaves out.
#include "measure/test/bars.h"

namespace dihaptic::measure {
namespace {

class GraspBars : public ::testing::TestWithParam<contact::Solver> {};
INSTANTIATE_TEST_SUITE_P(Soak, GraspBars,
                         ::testing::Values(contact::Solver::sequential_impulse,
                                           contact::Solver::stewart_trinkle,
                                           contact::Solver::staggered_projections),
                         solver_name);
TEST_P(GraspBars, AreReached) {
    expect_bars_of_grasp(GetParam());
}

TEST(VelocityImpulse, ReachesTheBars) {
    expect_bars_of_grasp(contact::Solver::newton, frame::CouplingKind::velocity_impulse);
}

class HoldBars : public ::testing::TestWithParam<contact::Solver> {};
INSTANTIATE_TEST_SUITE_P(Soak, HoldBars,
                         ::testing::Values(contact::Solver::newton,
                                           contact::Solver::sequential_impulse,
                                           contact::Solver::stewart_trinkle,
                                           contact::Solver::staggered_projections),
                         solver_name);
TEST_P(HoldBars, WhatFrictionHoldsIsHeldAndTheRestFalls) {
    for (const double friction : {0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.2}) {
        const auto [held, dropped] = held_and_dropped(friction);
        for (const double mass : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, held, dropped})
            expect_hold_as_friction_says(GetParam(), friction, mass);
    }
}

}  // namespace
}  // namespace dihaptic::measure
