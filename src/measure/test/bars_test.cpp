// Tests the bars of the default solver. A soak tests the bars of the other solvers, each of which
// takes a minute.
#include "measure/test/bars.h"

namespace dihaptic::measure::bars_test {
namespace {

TEST(GraspBars, AreReached) {
    expect_bars_of_grasp(contact::Solver::newton);
}

/// Tests both ends of the friction range 0.3 to 1.2, masses just below and above what the grip can
/// carry, and the lightest block. A soak tests all solvers, and the values in between.
TEST(BenchGrasp, HoldsWhatFrictionHoldsAndDropsTheRest) {
    for (const double friction : {0.3, 1.2}) {
        const auto [held, dropped] = held_and_dropped(friction);
        for (const double mass : {0.01, held, dropped})
            expect_hold_as_friction_says(contact::Solver::newton, friction, mass);
    }
}

TEST(BenchGrasp, ShowsTheFaultsOfTheDualSpring) {
    BenchSetup setup;
    setup.settings.coupling.kind = frame::CouplingKind::dual_spring;
    setup.settings.coupling.stiffness = 1000;
    EXPECT_GT(measure_kick(setup, 0.5).kick_ratio, 1.1);
    EXPECT_GT(measure_kick(setup, 0.5).leave_pull_n, 0.02);
    EXPECT_GT(measure_drag(setup), 0.002);
    EXPECT_FALSE(calm_grasp(measure_hold(setup)));
}

TEST(BenchGrasp, SeesWhatIsNotHeld) {
    BenchSetup setup;
    setup.settings.coupling.stiffness = 1000;
    setup.friction = 0.1;  // the block needs a grip of 4.9 N, but gets only 3.5 N
    EXPECT_FALSE(measure_hold(setup).held);
}

}  // namespace
}  // namespace dihaptic::measure::bars_test
