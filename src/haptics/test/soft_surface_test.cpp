// Tests soft surfaces with each type of proxy: they act as a spring in series with the coupling,
// and friction corresponds to the force that is felt.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "haptics/test/pressed.h"

namespace dihaptic::haptics::soft_surface_test {
namespace {

constexpr double kCoupling = kPressedCoupling;
using Proxy = PressedProxy;

class SoftSurface : public ::testing::TestWithParam<Proxy> {};
INSTANTIATE_TEST_SUITE_P(Haptics, SoftSurface,
                         ::testing::Values(Proxy::rigid, Proxy::point_apart, Proxy::point_solved),
                         name_of_proxy);

scene::Surface soft(double k) {
    scene::Surface out;
    out.stiffness = k;
    return out;
}

double in_series(double k) {
    return k * kCoupling / (k + kCoupling);
}

TEST_P(SoftSurface, IsFeltInSeriesWithTheCoupling) {
    for (const double k : {50.0, 300.0, 1000.0, 5000.0}) {
        for (const int every : {1, 5}) {
            Pressed pressed(GetParam(), soft(k), 0.8, every);
            for (const double depth : {0.005, 0.012, 0.003}) {
                const Vec3 f = pressed.go({0, 0, -depth});
                EXPECT_NEAR(f.z() / (in_series(k) * depth), 1, 0.005) << k << " " << depth;
                EXPECT_LT(f.head<2>().norm(), 1e-6);
            }
            EXPECT_EQ(pressed.go({0, 0, 0.001}), Vec3::Zero());
        }
    }
}

TEST_P(SoftSurface, HasTheFrictionOfWhatIsFelt) {
    constexpr double k = 400, kFriction = 0.5, kDepth = 0.01;
    Pressed pressed(GetParam(), soft(k), kFriction);
    const double normal = in_series(k) * kDepth;
    pressed.go({0, 0, -kDepth});
    // the surface holds the finger like a spring, up to the limit of the friction cone
    const Vec3 held = pressed.go({0.0005, 0, -kDepth});
    EXPECT_NEAR(held.x(), -kCoupling * 0.0005, 0.02 * kCoupling * 0.0005);
    const Vec3 slid = pressed.go({0.02, 0, -kDepth}, 0);
    EXPECT_NEAR(slid.z(), normal, 0.02 * normal);
    EXPECT_NEAR(slid.x(), -kFriction * slid.z(), 0.02 * normal);
}

TEST_P(SoftSurface, HoldsTheEnergyOfItsSpring) {
    constexpr double k = 400, kDepth = 0.01;
    Pressed pressed(GetParam(), soft(k), 0.5);
    pressed.go({0, 0, -kDepth});
    // the surface's spring is in the world for a rigid proxy, and in the coupling for a point
    const double coupling = GetParam() == Proxy::rigid
                                ? kCoupling / 2 * std::pow(kDepth * k / (k + kCoupling), 2)
                                : in_series(k) / 2 * kDepth * kDepth;
    EXPECT_NEAR(pressed.finger().stored(), coupling, 0.01 * coupling);
}

TEST_P(SoftSurface, ThatIsHardFeelsRigid) {
    Pressed hard(GetParam(), soft(1e6), 0.5);
    Pressed rigid(GetParam(), {}, 0.5);
    for (const double depth : {0.001, 0.008, 0.0}) {
        const double f = hard.go({0, 0, -depth}).z();
        EXPECT_NEAR(f, rigid.go({0, 0, -depth}).z(), 0.002 * f + 1e-9);
    }
}

}  // namespace
}  // namespace dihaptic::haptics::soft_surface_test
