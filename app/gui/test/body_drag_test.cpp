// Tests how dragging in the picture moves a body.
#include "body_drag.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dihaptic::gui::body_drag_test {
namespace {

/// A camera at the given azimuth that looks at the origin from above.
view::Camera camera_at(double azimuth) {
    view::Camera out;
    out.look_at = Vec3::Zero();
    out.position = Vec3(std::sin(azimuth), -std::cos(azimuth), 0.8) * 0.5;
    return out;
}

view::Ray to(const Vec3& p_W) {
    const Vec3 eye = camera_at(0.3).position;
    return {eye, (p_W - eye).normalized()};
}

TEST(BodyDrag, FollowsThePointerInTheTablesPlaneUpAndAround) {
    const Vec3 held(0.01, 0.02, 0.04);
    BodyDrag drag({0, held}, to(held), {rotation_xyz({0, 0, 0.1}), held});
    EXPECT_TRUE(drag.way().none());
    drag.follow(to({0.05, -0.03, 0.04}), {9, 9}, Qt::NoModifier);
    EXPECT_NEAR((drag.way().way - Vec3(0.04, -0.05, 0)).norm(), 0, 1e-12);
    drag.follow(to({0.05, -0.03, 0.14}), {9, 9}, Qt::ShiftModifier);
    EXPECT_NEAR((drag.way().way - Vec3(0.04, -0.05, 0.1)).norm(), 0, 1e-12);
    // turning does not displace the body, and the body does not jump when it is moved again
    drag.follow(to({0.2, 0.2, 0.14}), {100, 30}, Qt::ControlModifier);
    EXPECT_NEAR((drag.way().way - Vec3(0.04, -0.05, 0.1)).norm(), 0, 1e-12);
    EXPECT_NEAR(drag.way().turn, 0.8, 1e-12);
    drag.follow(to({0.21, 0.2, 0.14}), {9, 9}, Qt::NoModifier);
    EXPECT_NEAR((drag.way().way - Vec3(0.05, -0.05, 0.1)).norm(), 0, 1e-12);
    const Pose X_WB = drag.X_WB();
    EXPECT_NEAR((X_WB.p - held - drag.way().way).norm(), 0, 1e-12);
    EXPECT_NEAR((angles_xyz(X_WB.R) - Vec3(0, 0, 0.9)).norm(), 0, 1e-12);
}

TEST(BodyDrag, WaitsForAPointerAboveTheHorizonToComeBack) {
    const Vec3 held(0, 0, 0.02);
    BodyDrag drag({0, held}, to(held), {});
    drag.follow({camera_at(0.3).position, Vec3::UnitZ()}, {0, -500}, Qt::NoModifier);
    EXPECT_TRUE(drag.way().none());
    drag.follow(to({0, 0.1, 0.02}), {0, 400}, Qt::NoModifier);
    EXPECT_NEAR((drag.way().way - Vec3(0, 0.1, 0)).norm(), 0, 1e-12);
}

TEST(BodyDrag, KeysGoAsThePictureHasIt) {
    const auto step = [](int key, double azimuth, Qt::KeyboardModifiers with = Qt::NoModifier) {
        return step_of(QKeyEvent(QEvent::KeyPress, key, with), camera_at(azimuth));
    };
    EXPECT_EQ(*step(Qt::Key_Right, 0.6), Vec3(0.001, 0, 0));
    EXPECT_EQ(*step(Qt::Key_Right, -0.6), Vec3(0.001, 0, 0));
    EXPECT_EQ(*step(Qt::Key_Right, 1), Vec3(0, 0.001, 0));
    EXPECT_EQ(*step(Qt::Key_Up, 1), Vec3(-0.001, 0, 0));
    EXPECT_EQ(*step(Qt::Key_Up, 3), Vec3(0, -0.001, 0));
    EXPECT_EQ(*step(Qt::Key_Left, -1.5, Qt::ShiftModifier), Vec3(0, 0.010, 0));
    EXPECT_EQ(*step(Qt::Key_Down, 0), Vec3(0, -0.001, 0));
    EXPECT_EQ(*step(Qt::Key_PageUp, 2, Qt::ShiftModifier), Vec3(0, 0, 0.010));
    EXPECT_EQ(*step(Qt::Key_PageDown, 2), Vec3(0, 0, -0.001));
    EXPECT_FALSE(step(Qt::Key_A, 0));
}

}  // namespace
}  // namespace dihaptic::gui::body_drag_test
