// Tests the bars of what users of other simulators have published.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/public_tests.h"
#include "bench/test/friction_bars.h"

namespace dihaptic::bench::public_tests_test {
namespace {

TEST(PublicTests, ArePassedByTheDefaultSolver) {
    const PublicFigures figures = bench_peer_public(world_simulator({}), {});
    ASSERT_TRUE(figures.capsule_12_um_s && figures.capsule_60_um_s && figures.pushed_um_s);
    for (const double creep :
         {*figures.capsule_12_um_s, *figures.capsule_60_um_s, *figures.pushed_um_s})
        EXPECT_LE(std::abs(creep), 1e-3);
    EXPECT_EQ(figures.holds_from, 1);
    EXPECT_EQ(figures.slips_to, 0.999);
    ASSERT_TRUE(figures.lift_slip_mm);
    EXPECT_LE(*figures.lift_slip_mm, 1e-3);
}

TEST(PublicTests, TellThatABlockWasLost) {
    // pads that nothing presses: everything that is held must fall
    const Simulator pressless{"pressless", [](const Trial& trial, int steps, const Watch& watch) {
                                  Trial loose = trial;
                                  for (Trial::Push& push : loose.pushes) push.force_W.x() = 0;
                                  world_simulator({}).run(loose, steps, watch);
                              }};
    const PublicFigures figures = bench_peer_public(pressless, {});
    EXPECT_FALSE(figures.capsule_12_um_s);
    EXPECT_FALSE(figures.holds_from);
    EXPECT_EQ(figures.slips_to, 1.10);
    EXPECT_FALSE(figures.lift_slip_mm);
    EXPECT_FALSE(figures.grip_n);
}

TEST(PublicTests, GiveOneForceWithAllSolvers) {
    const double expected = measure_grip({});
    for (int i = 0; i < contact::kSolvers; ++i) {
        const auto solver = static_cast<contact::Solver>(i);
        EXPECT_NEAR(measure_grip(settings_of(solver)), expected, 1e-6) << enum_name(solver);
    }
}

}  // namespace
}  // namespace dihaptic::bench::public_tests_test
