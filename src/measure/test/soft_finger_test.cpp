// Tests soft fingertips (points and spheres) against statics.
#include <gtest/gtest.h>

#include <numbers>

#include "measure/grasp.h"

namespace dihaptic::measure::soft_finger_test {
namespace {

constexpr double kGravity = 9.81;

class SoftFinger : public ::testing::TestWithParam<scene::ProxyKind> {
  protected:
    BenchSetup setup;
    SoftFinger() {
        setup.settings.proxy.kind = GetParam();
        setup.soft_radius = kSoftRadius;
        setup.hold_time = 2;
    }
};
INSTANTIATE_TEST_SUITE_P(Proxies, SoftFinger,
                         ::testing::Values(scene::ProxyKind::rigid, scene::ProxyKind::point),
                         [](const auto& of) { return std::string(enum_name(of.param)); });

TEST_P(SoftFinger, LetsGoAtTheEllipticLimit) {
    EXPECT_NEAR(measure_torsion_limit(setup), 1, 0.05);
    EXPECT_LT(measure_soft_turn(setup, 0.8), 1);
    EXPECT_GT(measure_soft_turn(setup, 1.2), 90);
    const double light = torsion_limit(setup);
    // close to slipping under the weight, the contacts can bear little torsion: T / (mu N) is 0.92
    setup.mass = 0.52;
    EXPECT_LT(torsion_limit(setup), 0.4 * light);
    EXPECT_NEAR(measure_torsion_limit(setup), 1, 0.05);
}

TEST_P(SoftFinger, ATiltedHoldTurnsTheBlockUntilItsContactsAreInLineWithTheForces) {
    setup.fingering = Fingering::offset;
    const hand::HandSpec hand = grasp_hand(setup);
    Bench bench(grasp_scene(setup), hand, setup);
    frame::Frame last;
    bench.run([&](const frame::Frame& frame) {
        if (frame.phase == kHold) last = frame;
    });
    constexpr double kDegree = std::numbers::pi / 180;
    ASSERT_EQ(last.contacts.size(), 2u);
    std::array<Vec3, 2> at;
    for (const frame::ContactFrame& c : last.contacts)
        at[static_cast<size_t>(std::max(c.a, c.b) - 2)] = c.p_WC;
    // each finger carries half of the weight; the remaining forces of the two fingers are opposite
    const Vec3 squeeze = last.fingers[1].f_contact_W - last.fingers[0].f_contact_W;
    EXPECT_LT(squeeze.normalized().cross((at[1] - at[0]).normalized()).norm(), 0.1 * kDegree);
    if (GetParam() == scene::ProxyKind::point) {
        const Vec3 targets = hand.fingers[1].offset - hand.fingers[0].offset +
                             Vec3(kBlockSize - 2 * setup.squeeze, 0, 0);
        EXPECT_LT((at[1] - at[0]).normalized().cross(targets.normalized()).norm(), 0.1 * kDegree);
    }
    EXPECT_GT(angle_between(last.bodies[1].X_WB.R, Quat::Identity()), 10 * kDegree);
    EXPECT_LT(last.bodies[1].w_WB.norm(), 1e-6);
}

TEST_P(SoftFinger, AnOffCentreHoldStaysLevelOrSwingsDownAsFarAsStaticsSays) {
    // both fingers are off centre along the face; the moment of the weight is first below and then
    // far above the limit, and fingers that slip while the block swings down stay on the face
    struct Case {
        double mass;
        double off;
        bool level;
    };
    for (const Case& c : {Case{0.1, 0.015, true}, Case{0.35, 0.012, false}}) {
        SCOPED_TRACE(c.mass);
        setup.mass = c.mass;
        setup.hold_time = 5;
        hand::HandSpec hand = grasp_hand(setup);
        for (hand::FingerPlace& finger : hand.fingers) finger.offset = {0, c.off, 0};
        Bench bench(grasp_scene(setup), hand, setup);
        frame::Frame last;
        bench.run([&](const frame::Frame& frame) {
            if (frame.phase == kHold) last = frame;
        });
        const dynamics::BodyState block{last.bodies[1].X_WB, last.bodies[1].v_WB,
                                        last.bodies[1].w_WB};
        const double turned = angle_between(block.X_WB.R, Quat::Identity());
        const Vec3 axis = (last.fingers[0].p_WP + last.fingers[1].p_WP) / 2;
        const double moment = c.mass * kGravity * std::abs(block.X_WB.p.y() - axis.y());
        EXPECT_LT(block.w_WB.norm(), 1e-4);
        EXPECT_LT(moment, 1.01 * torsion_limit(setup));
        if (c.level) {
            EXPECT_LT(turned, std::numbers::pi / 180);
        } else {
            EXPECT_GT(c.mass * kGravity * c.off, 1.2 * torsion_limit(setup));
            EXPECT_GT(turned, 20 * std::numbers::pi / 180);
        }
    }
}

}  // namespace
}  // namespace dihaptic::measure::soft_finger_test
