#include "mouse_hand.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dihaptic::gui {
namespace {

class MouseHandTest : public ::testing::Test {
  protected:
    hand::Posture start{{0, 0, 0.05}, 0.08};
    MouseHand mouse{start};
    scene::Camera camera;

    MouseHandTest() { camera.position = {0, -0.5, 0.35}; }
    Vec3 moved(const QPointF& pixels, bool in_depth) {
        mouse.move(pixels, camera, 600, in_depth);
        return mouse.goal().centre - start.centre;
    }
};

TEST_F(MouseHandTest, FollowsThePointerAcrossAndUp) {
    const Vec3 way = moved({10, -20}, false);
    EXPECT_GT(way.x(), 0);
    EXPECT_NEAR(way.z(), 2 * way.x(), 1e-12);
    EXPECT_EQ(way.y(), 0);
}

TEST_F(MouseHandTest, FollowsItInDepthWithTheModifier) {
    const Vec3 way = moved({0, -20}, true);
    EXPECT_GT(way.y(), 0);
    EXPECT_NEAR(way.x(), 0, 1e-12);
    EXPECT_EQ(way.z(), 0);
}

/// Moving the pointer by the height of the picture moves the hand by the height of the view at the
/// hand's depth.
TEST_F(MouseHandTest, MovesAsFarAsThePictureShows) {
    camera.position = {0, -0.4, 0.05};
    camera.look_at = {0, 0, 0.05};
    EXPECT_NEAR(moved({60, 0}, false).x(), 0.1 * 2 * 0.4 * std::tan(camera.field_of_view / 2),
                1e-12);
}

TEST_F(MouseHandTest, RightIsRightFromEverySide) {
    camera.position = {0.5, 0, 0.3};  // from the right: right is away from the person
    EXPECT_GT(moved({30, 0}, false).y(), 0.01);
    camera.position = {0, 0, 0.6};  // from above
    const Vec3 before = mouse.goal().centre;
    mouse.move({30, 0}, camera, 600, false);
    EXPECT_GT(mouse.goal().centre.x() - before.x(), 0.01);
}

TEST_F(MouseHandTest, StaysAtTheDesk) {
    moved({1e6, 1e6}, false);
    EXPECT_LE(mouse.goal().centre.x(), 0.3);
    EXPECT_GT(mouse.goal().centre.z(), 0);
}

TEST_F(MouseHandTest, ComesBackWithThePointerFromTheEndOfTheDesk) {
    for (int i = 0; i < 50; ++i) mouse.move({0, 10}, camera, 600, false);
    EXPECT_NEAR(mouse.goal().centre.z(), 0.005, 1e-12);
    for (int i = 0; i < 50; ++i) mouse.move({0, -10}, camera, 600, false);
    EXPECT_NEAR(mouse.goal().centre.z(), start.centre.z(), 2e-3);
}

TEST_F(MouseHandTest, GoesBackToWhereItBeganAndHoldsWhatItHolds) {
    moved({300, -200}, false);
    mouse.turn({50, 50});
    mouse.wheel(5);
    const double aperture = mouse.goal().aperture;
    mouse.go_back();
    EXPECT_EQ(mouse.goal().centre, start.centre);
    EXPECT_EQ(mouse.goal().yaw, start.yaw);
    EXPECT_EQ(mouse.goal().aperture, aperture);
    EXPECT_NEAR((moved({10, 0}, false)).norm(), 0.01, 0.01);
}

TEST_F(MouseHandTest, SqueezesAsHardAsItsDevicesLetIt) {
    EXPECT_EQ(MouseHand::grip_of(8.5), 4.25);
    EXPECT_EQ(MouseHand::grip_of(60), 16);  // 800 g of silk require 11 N
    MouseHand strong(start, 12);
    strong.set_grip(11);
    strong.wheel(1);
    EXPECT_LT(strong.goal().aperture, start.aperture);
    strong.set_grip(12.5);
    const double held = strong.goal().aperture;
    strong.wheel(1);
    EXPECT_EQ(strong.goal().aperture, held);
}

TEST_F(MouseHandTest, AimsBehindWhatItHoldsAndNeverCrossesItsFingersWithoutIt) {
    mouse.wheel(100);
    EXPECT_EQ(mouse.goal().aperture, 0);
    mouse.set_grip(2);
    mouse.wheel(5);
    EXPECT_NEAR(mouse.goal().aperture, -5 * MouseHand::kNotch, 1e-12);
    mouse.set_grip(0);
    EXPECT_EQ(mouse.goal().aperture, 0);
    mouse.set_grip(std::nan(""));  // NaN, as with one finger
    mouse.wheel(5);
    EXPECT_EQ(mouse.goal().aperture, 0);
}

TEST_F(MouseHandTest, SqueezesByWheelAndKeys) {
    mouse.wheel(2);
    EXPECT_NEAR(mouse.goal().aperture, 0.08 - 2 * MouseHand::kNotch, 1e-12);
    mouse.squeeze(MouseHand::Squeeze::close, 0.1);
    EXPECT_NEAR(mouse.goal().aperture, 0.08 - 2 * MouseHand::kNotch - 0.1 * MouseHand::kKeySpeed,
                1e-12);
    for (int i = 0; i < 100; ++i) mouse.squeeze(MouseHand::Squeeze::close, 0.1);
    EXPECT_EQ(mouse.goal().aperture, 0);
}

TEST_F(MouseHandTest, ClosesNoFurtherWhenItHoldsFirmlyAndOpensAtOnce) {
    mouse.set_grip(1.1 * MouseHand::kMostGrip);
    mouse.wheel(1);
    mouse.squeeze(MouseHand::Squeeze::close, 0.1);
    EXPECT_EQ(mouse.goal().aperture, 0.08);
    mouse.squeeze(MouseHand::Squeeze::open, 0.1);
    EXPECT_GT(mouse.goal().aperture, 0.08);
}

TEST_F(MouseHandTest, TurnsByADragButNotHeadOver) {
    mouse.turn({100, 0});
    EXPECT_NEAR(mouse.goal().yaw, 100 * MouseHand::kTurn, 1e-12);
    mouse.turn({0, 10000});
    EXPECT_NEAR(mouse.goal().roll, M_PI / 2, 1e-12);
}

}  // namespace
}  // namespace dihaptic::gui
