#include "view/camera.h"

#include <gtest/gtest.h>

namespace dihaptic::view::camera_test {
namespace {

constexpr double kPi = std::numbers::pi;

Camera in_front() {
    Camera camera;
    camera.position = {0.1, -0.5, 0.3};
    camera.look_at = {0.1, 0, 0.05};
    return camera;
}

double distance(const Camera& camera) {
    return (camera.position - camera.look_at).norm();
}

/// The position of a point in the picture; x points right and y up, both from -1 to 1.
Eigen::Vector2d seen(const Camera& camera, const Vec3& p_W) {
    const Eigen::Vector4d clip = projection(camera, 1.5, 0.01, 10) * p_W.homogeneous();
    return clip.head<2>() / clip.w();
}

TEST(Camera, WhatItLooksAtIsInTheMiddleAndTheVerticalUpright) {
    const Camera camera = in_front();
    EXPECT_LT(seen(camera, camera.look_at).norm(), 1e-12);
    const Eigen::Vector2d above = seen(camera, camera.look_at + Vec3(0, 0, 0.1));
    EXPECT_NEAR(above.x(), 0, 1e-12);
    EXPECT_GT(above.y(), 0);
    EXPECT_GT(seen(camera, camera.look_at + Vec3(0.1, 0, 0)).x(), 0);
}

TEST(Camera, TheFieldOfViewGoesFromBottomToTop) {
    const Camera camera = in_front();
    const Vec3 up = view_pose(camera).R * Vec3::UnitY();
    const double edge = distance(camera) * std::tan(camera.field_of_view / 2);
    EXPECT_NEAR(seen(camera, camera.look_at + edge * up).y(), 1, 1e-12);
}

TEST(Camera, StraightDownThePersonsFarSideIsUp) {
    Camera camera = in_front();
    camera.position = camera.look_at + Vec3(0, 0, 0.5);
    EXPECT_GT(seen(camera, camera.look_at + Vec3(0, 0.1, 0)).y(), 0.1);
    EXPECT_GT(seen(camera, camera.look_at + Vec3(0.1, 0, 0)).x(), 0.1);
}

TEST(Camera, OrbitsKeepTheDistanceAndComeBack) {
    const Camera camera = in_front();
    const Camera turned = orbited(camera, 0.7, 0.3);
    EXPECT_NEAR(distance(turned), distance(camera), 1e-12);
    EXPECT_EQ(turned.look_at, camera.look_at);
    EXPECT_LT((orbited(turned, -0.7, -0.3).position - camera.position).norm(), 1e-12);
    EXPECT_LT((orbited(camera, 2 * kPi, 0).position - camera.position).norm(), 1e-12);
}

TEST(Camera, AnOrbitOverTheTopStopsThereAndRemembersWhereItCameFrom) {
    const Camera turned = orbited(in_front(), 0.7, 0);
    const Camera top = orbited(turned, 0, 10);
    EXPECT_NEAR(top.position.z() - top.look_at.z(), distance(turned), 1e-9);
    const Camera back = orbited(top, 0, -kPi / 4);
    const Vec3 d = back.position - back.look_at;
    EXPECT_NEAR(std::atan2(d.x(), -d.y()), 0.7, 1e-6);
}

TEST(Camera, APanMovesTheSceneWithTheMouse) {
    const Camera camera = in_front();
    const Camera moved = panned(camera, 0.1, 0.2);
    // the point in the middle moves by a tenth of the picture's height to the right and a fifth up
    const Eigen::Vector2d at = seen(moved, camera.look_at);
    EXPECT_NEAR(at.x(), 2 * 0.1 / 1.5, 1e-12);
    EXPECT_NEAR(at.y(), 2 * 0.2, 1e-12);
}

TEST(Camera, ZoomingStaysWithinReason) {
    const Camera camera = in_front();
    EXPECT_NEAR(distance(zoomed(camera, 0.5)), distance(camera) / 2, 1e-12);
    EXPECT_NEAR(distance(zoomed(camera, 0)), 0.01, 1e-12);
    EXPECT_NEAR(distance(zoomed(camera, 1e9)), 100, 1e-9);
}

TEST(Camera, EverySceneHasFrontAboveAndSideAndAFileMayReplaceThem) {
    scene::Scene scene;
    Camera own = in_front();
    own.name = "above";
    scene.cameras = {own};
    const std::vector<Camera> all = cameras(scene);
    ASSERT_EQ(all.size(), 3);
    EXPECT_EQ(all[0].name, "above");
    EXPECT_EQ(all[0].position, own.position);
    EXPECT_EQ(find_camera(all, "front").name, "front");
    try {
        find_camera(all, "below");
        FAIL();
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(),
                     "error: there is no camera 'below'. Available cameras: above, front, side; a "
                     "scene may define more, under 'cameras'.");
    }
}

}  // namespace
}  // namespace dihaptic::view::camera_test
