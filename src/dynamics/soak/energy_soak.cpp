// Tests that no solver creates energy in hundreds of random scenes.
#include <gtest/gtest.h>

#include <cstdio>

#include "dynamics/test/energy_scenes.h"

namespace dihaptic::dynamics {
namespace {

constexpr int kScenes = 200;
constexpr int kSteps = 1000;
constexpr double kRise = 1e-6;

class EnergySoak : public ::testing::TestWithParam<contact::Solver> {};
INSTANTIATE_TEST_SUITE_P(
    World, EnergySoak,
    ::testing::Values(contact::Solver::sequential_impulse, contact::Solver::stewart_trinkle,
                      contact::Solver::staggered_projections, contact::Solver::newton),
    [](const auto& which) {
        return std::string(enum_names(contact::Solver{})[static_cast<size_t>(which.param)]);
    });

TEST_P(EnergySoak, NoStepRaisesItWithoutAnOverlap) {
    frame::DynamicsSettings settings;
    settings.solver = GetParam();
    int raised_from_overlap = 0;
    double worst = 0;
    double worst_clean = 0;
    for (uint64_t seed = 0; seed < kScenes; ++seed) {
        EnergyScene scene(seed, settings);
        for (int i = 0; i < kSteps; ++i) {
            const double rise = scene.step();
            worst = std::max(worst, rise);
            if (!scene.overlapped()) worst_clean = std::max(worst_clean, rise);
            if (rise <= kRise) continue;
            EXPECT_TRUE(scene.overlapped()) << "scene " << seed << ", step " << i;
            ++raised_from_overlap;
        }
    }
    // bodies that spin into each other sometimes overlap, and are then pushed apart
    EXPECT_LT(raised_from_overlap, kScenes * kSteps / 2000);
    std::printf("worst rise %.1e; from overlaps %d above %.0e, %.1e at worst\n", worst_clean,
                raised_from_overlap, kRise, worst);
}

TEST_P(EnergySoak, NoStepRaisesItWhenOverlapsAreLeft) {
    if (GetParam() == contact::Solver::sequential_impulse)
        GTEST_SKIP()
            << "sweeps that end at their bound, in a step of some ten thousand, gain energy";
    frame::DynamicsSettings settings;
    settings.solver = GetParam();
    settings.penetration_recovery = 0;
    double worst = 0;
    for (uint64_t seed = 0; seed < kScenes; ++seed) {
        EnergyScene scene(seed, settings);
        for (int i = 0; i < kSteps; ++i) {
            const double rise = scene.step();
            worst = std::max(worst, rise);
            EXPECT_LE(rise, kRise) << "scene " << seed << ", step " << i;
        }
    }
    std::printf("worst rise %.1e\n", worst);
}

}  // namespace
}  // namespace dihaptic::dynamics
