// Tests the bars of the default solver; a soak tests those of the others, each of which takes a
// minute.
#include "measure/test/bars.h"

namespace dihaptic::measure::bars_test {
namespace {

TEST(GraspBars, AreReached) {
    expect_bars_of_grasp(contact::Solver::newton);
}

/// Friction at the ends of 0.3 to 1.2, masses on both sides of what the grip can carry, and the
/// lightest block; a soak tests all solvers, and the grid in between.
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
    setup.friction = 0.1;  // the block needs 4.9 N of grip, and gets 3.5 N
    EXPECT_FALSE(measure_hold(setup).held);
}

}  // namespace
}  // namespace dihaptic::measure::bars_test
