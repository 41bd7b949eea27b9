// Tests that a picture shows things as described by the Frame: hidden, coloured or displaced.
#include <gtest/gtest.h>

#include <cstdlib>

#include "software_renderer.h"
#include "view/scene_view.h"

namespace dihaptic::view::looks_test {
namespace {

constexpr int kSize = 160;

scene::Scene table_with_block(const std::string& colour) {
    scene::Scene scene;
    scene.bodies.resize(2);
    scene.bodies[0].name = "table";
    scene.bodies[0].shape = scene::Shape::box({0.6, 0.4, 0.05});
    scene.bodies[0].position = {0, 0, -0.025};
    scene.bodies[0].fixed = true;
    scene.bodies[0].colour = "#b0b0b0";
    scene.bodies[1].name = "block";
    scene.bodies[1].shape = scene::Shape::box({0.04, 0.04, 0.04});
    scene.bodies[1].position = {0, 0, 0.06};
    scene.bodies[1].mass = 0.1;
    scene.bodies[1].colour = colour;
    return scene;
}

frame::Frame start(const scene::Scene& scene) {
    frame::Frame frame;
    for (const scene::Body& body : scene.bodies) frame.bodies.push_back({body.pose()});
    return frame;
}

Image picture(const scene::Scene& scene, const frame::Frame& frame) {
    Camera camera;
    camera.look_at = {0, 0, 0.03};
    camera.position = {0.1, -0.3, 0.3};
    const Offscreen offscreen = software_offscreen(kSize, kSize);
    SceneView view(scene);
    view.draw(frame, camera, kSize, kSize);
    return offscreen.read();
}

/// The number of pixels that differ by more than a rounding error.
int different(const Image& a, const Image& b) {
    int count = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            int most = 0;
            for (size_t i = 0; i < 3; ++i)
                most = std::max(most, std::abs(int{a.at(x, y)[i]} - int{b.at(x, y)[i]}));
            if (most > 2) ++count;
        }
    }
    return count;
}

TEST(Looks, AHiddenBodyIsNotSeenNorItsShadow) {
    const scene::Scene scene = table_with_block("#0072b2");
    frame::Frame frame = start(scene);
    const Image whole = picture(scene, frame);
    frame.task.looks = {{1, 1, -1, 1}};
    const Image hidden = picture(scene, frame);
    EXPECT_GT(different(whole, hidden), 1000);  // pixels of the block and its shadow
    // the block is so far below the table that neither the block nor its shadow is visible
    frame::Frame without = start(scene);
    without.bodies[1].X_WB.p = {0, 0, -0.5};
    EXPECT_LT(different(picture(scene, without), hidden), 20);
}

TEST(Looks, AColourAndASizeTakeTheSceneSPlace) {
    frame::Frame frame = start(table_with_block("#0072b2"));
    frame.task.looks = {{1, 0, 0xd55e00, 1}};
    const Image coloured = picture(table_with_block("#0072b2"), frame);
    const Image given = picture(table_with_block("#d55e00"), start(table_with_block("#d55e00")));
    EXPECT_EQ(different(coloured, given), 0);
    frame.task.looks[0].scale = 1.5;
    EXPECT_GT(different(picture(table_with_block("#0072b2"), frame), coloured), 300);
}

TEST(Looks, ADisplacedBodyIsDrawnWhereItIsShown) {
    const scene::Scene scene = table_with_block("#0072b2");
    frame::Frame frame = start(scene);
    frame.bodies[1].X_WB.p = {0.05, 0, 0.06};
    const Image moved = picture(scene, frame);
    frame = start(scene);
    frame.task.displaced = {{1, {Quat::Identity(), {0.05, 0, 0.06}}}};
    EXPECT_EQ(different(picture(scene, frame), moved), 0);
}

TEST(Looks, ATargetHasTheColourThatItIsGiven) {
    const scene::Scene scene = table_with_block("#0072b2");
    frame::Frame frame = start(scene);
    frame.task.targets = {{0, {-0.05, 0, 0.06}, 0.02}};
    const Image usual = picture(scene, frame);
    frame.task.targets[0].colour = 0xd55e00;
    EXPECT_EQ(different(picture(scene, frame), usual), 0);
    frame.task.targets[0].colour = 0x00a000;
    EXPECT_GT(different(picture(scene, frame), usual), 200);
}

}  // namespace
}  // namespace dihaptic::view::looks_test
