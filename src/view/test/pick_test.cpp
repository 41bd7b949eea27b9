// Tests which body a person points at: the first one that the line of sight meets.
#include "view/pick.h"

#include <gtest/gtest.h>

#include "drawn_points.h"

namespace dihaptic::view::pick_test {
namespace {

Camera from_the_front() {
    Camera out;
    out.position = {0, -0.5, 0};
    out.look_at = {0, 0, 0};
    return out;
}

TEST(Pick, ARayIsThePinholesLine) {
    const Camera camera = from_the_front();
    const double aspect = 1.6;
    const Eigen::Matrix4d clip = projection(camera, aspect, 0.01, 10);
    for (const auto& [right, up] : {std::pair{0.0, 0.0}, {0.7, -0.3}, {-1.5, 0.9}}) {
        const Ray ray = ray_through(camera, right, up);
        const Eigen::Vector4d at = clip * Vec3(ray.from_W + 0.4 * ray.along_W).homogeneous();
        EXPECT_NEAR(at.x() / at.w(), right / aspect, 1e-12);
        EXPECT_NEAR(at.y() / at.w(), up, 1e-12);
    }
}

TEST(Pick, FindsTheNearestAndNothingBesideIt) {
    Balls balls;
    balls.add({0, 0.1, 0}, 0.05);
    balls.add({0, -0.1, 0}, 0.01);
    const Ray ahead = ray_through(from_the_front(), 0, 0);
    EXPECT_EQ(seen_first(balls.scene, balls.frame, ahead)->body, 1u);
    // 20 mm above the middle of the small ball, so that the ray meets the large ball behind it
    const Ray above{{0, -0.5, 0.02}, Vec3::UnitY()};
    EXPECT_EQ(seen_first(balls.scene, balls.frame, above)->body, 0u);
    EXPECT_FALSE(seen_first(balls.scene, balls.frame, {{0, -0.5, 0.0505}, Vec3::UnitY()}));
    EXPECT_FALSE(seen_first(balls.scene, balls.frame, {{0, -0.5, 0}, -Vec3::UnitY()}));
    // the frame determines the position of the ball
    balls.frame.bodies[1].X_WB.p = {0, 0.3, 0};
    EXPECT_EQ(seen_first(balls.scene, balls.frame, ahead)->body, 0u);
}

TEST(Pick, FindsTheBlockOnItsTable) {
    Balls scene;
    scene::Body table;
    table.name = "table";
    table.shape = scene::Shape::box({0.6, 0.4, 0.05});
    table.position = {0, 0, -0.025};
    scene::Body block = table;
    block.name = "block";
    block.shape = scene::Shape::box({0.04, 0.04, 0.04});
    block.position = {0, 0, 0.02};
    for (const scene::Body& body : {table, block}) {
        scene.scene.bodies.push_back(body);
        scene.frame.bodies.push_back({body.pose()});
    }
    Camera camera = from_the_front();
    camera.position = {-0.25, -0.4, 0.29};
    camera.look_at = {0.02, 0, 0.065};
    const Eigen::Matrix4d clip = projection(camera, 1, 0.01, 10);
    const auto at = [&](const Vec3& p_W) {
        const Eigen::Vector4d place = clip * p_W.homogeneous();
        return seen_first(scene.scene, scene.frame,
                          ray_through(camera, place.x() / place.w(), place.y() / place.w()))
            ->body;
    };
    EXPECT_EQ(at({0, 0, 0.04}), 1u);
    EXPECT_EQ(at({0, -0.02, 0.02}), 1u);
    EXPECT_EQ(at({0, -0.1, 0}), 0u);
}

TEST(Pick, TellsWhereARayMeetsTheBody) {
    Balls balls;
    balls.add({0.01, 0.1, 0}, 0.05);
    const auto seen = seen_first(balls.scene, balls.frame, {{0.01, -0.5, 0}, Vec3::UnitY()});
    ASSERT_TRUE(seen);
    EXPECT_NEAR((seen->p_W - Vec3(0.01, 0.05, 0)).norm(), 0, 1e-4);  // the ball has flat faces
}

Ray from_to(const Vec3& eye, const Vec3& p_W) {
    return {eye, (p_W - eye).normalized()};
}

TEST(Pick, WhatIsDraggedStaysUnderThePointer) {
    const Vec3 eye(0.3, -0.5, 0.4), held(0.02, 0.05, 0.06);
    const Vec3 beside(-0.1, 0.2, 0.06), above(0.02, 0.05, 0.15);
    const auto level = dragged(held, from_to(eye, held), from_to(eye, beside), false);
    ASSERT_TRUE(level);
    EXPECT_NEAR((*level - (beside - held)).norm(), 0, 1e-12);
    const auto up = dragged(held, from_to(eye, held), from_to(eye, above), true);
    ASSERT_TRUE(up);
    // the height is measured in the upright plane that faces the second line of sight
    EXPECT_NEAR((*up - (above - held)).norm(), 0, 1e-12);
}

TEST(Pick, NothingIsDraggedToTheHorizonOrFromStraightAbove) {
    const Vec3 eye(0, -0.5, 0.4), held(0, 0, 0.02);
    const Ray now = from_to(eye, held);
    EXPECT_FALSE(dragged(held, now, {eye, Vec3::UnitY()}, false));
    EXPECT_FALSE(dragged(held, now, from_to(eye, {0, 100, 0.02}), false));
    EXPECT_FALSE(dragged(held, now, from_to(eye, {0, 0, 1}), false));
    const Vec3 over(0, 0, 0.5);
    EXPECT_FALSE(dragged(held, from_to(over, held), from_to(over, {0.01, 0, 0}), true));
}

}  // namespace
}  // namespace dihaptic::view::pick_test
