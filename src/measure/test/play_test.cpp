// Tests a few seconds of play with each solver; src/measure/soak/play_soak.cpp tests ten minutes.
#include "measure/test/play.h"

#include "measure/test/bars.h"

namespace dihaptic::measure::play_test {
namespace {

TEST(Overlap, OfShapesWhoseDepthIsKnown) {
    const Rounded cube{Vec3::Constant(0.02), 0};
    const Rounded ball{Vec3::Zero(), 0.01};
    const Rounded capsule{{0, 0, 0.02}, 0.01};
    const Pose here;
    const auto at = [](double x, double y, double z) { return Pose{Quat::Identity(), {x, y, z}}; };
    EXPECT_NEAR(overlap(cube, here, cube, at(0.039, 0, 0.01)), 0.001, 1e-12);
    EXPECT_NEAR(overlap(cube, here, cube, at(0.041, 0, 0.01)), -0.001, 1e-12);
    // one edge points toward a face
    const Pose turned{rotation_xyz({0, 0, 0.7853981633974483}), {0.02 + 0.027, 0, 0}};
    EXPECT_NEAR(overlap(cube, here, cube, turned), 0.02 * std::sqrt(2) - 0.027, 1e-12);
    EXPECT_NEAR(overlap(ball, here, cube, at(0.029, 0.005, 0)), 0.001, 1e-12);
    const double corner = 0.02 + 0.009 / std::sqrt(3);
    EXPECT_NEAR(overlap(ball, here, cube, at(corner, corner, corner)), 0.001, 1e-12);
    EXPECT_NEAR(overlap(ball, at(0.019, 0, 0.015), capsule, here), 0.001, 1e-9);
    EXPECT_NEAR(overlap(capsule, at(0.019, 0, 0.01), capsule, here), 0.001, 1e-9);
    // the capsule's line is nearest to the cube's edge at the end of the line
    EXPECT_NEAR(overlap(capsule, at(0.026, 0, 0.048), cube, here), 0.01 - std::hypot(0.006, 0.008),
                1e-9);
}

class PlayTest : public ::testing::TestWithParam<contact::Solver> {};
INSTANTIATE_TEST_SUITE_P(Solvers, PlayTest,
                         ::testing::Values(contact::Solver::sequential_impulse,
                                           contact::Solver::stewart_trinkle,
                                           contact::Solver::staggered_projections,
                                           contact::Solver::newton),
                         solver_name);
TEST_P(PlayTest, HarmsNothing) {
    int64_t held = 0;
    for (const uint64_t seed : {1, 2}) held += expect_harmless_play(GetParam(), seed, 5).held;
    EXPECT_GT(held, 0);
}
TEST_P(PlayTest, HarmsNothingWithAPoint) {
    expect_harmless_play(GetParam(), 1, 5, scene::ProxyKind::point);
}
TEST_P(PlayTest, TripsTheEnergyGuardWhenTheCouplingHasNegativeDamping) {
    frame::Settings settings;
    settings.dynamics.solver = GetParam();
    settings.coupling.damping = -1;
    settings.safety.energy_guard = frame::EnergyGuardMode::act;
    const PlayReport report = Play(settings, 1).run(5);
    EXPECT_NE(report.status & kEnergyGenerated, 0u);
    EXPECT_NE(report.status & kEnergyDamped, 0u);
    EXPECT_EQ(report.status & kNotFinite, 0u);
    EXPECT_LE(report.largest_force, 8.5 + 1e-9);
}

}  // namespace
}  // namespace dihaptic::measure::play_test
