// Tests, numerically and in pictures, that each eye sees a thing on a display where a pinhole
// camera at that eye would see it.
#include "view/panes.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "drawn_points.h"
#include "software_renderer.h"
#include "view/scene_view.h"

namespace dihaptic::view::panes_test {
namespace {

constexpr int kDisplays = 20;
constexpr int kWidth = 960, kHeight = 720;

/// A random display in front of the person, tilted and offset, as in any rig.
display::Display random_display(Random& random, int i) {
    const auto vector = [&](double most) {
        return Vec3(random.uniform(-most, most), random.uniform(-most, most),
                    random.uniform(-most, most));
    };
    display::Display out;
    const Quat R = rotation_xyz(Vec3(std::numbers::pi / 4, 0, 0) + vector(0.6));
    const double width = random.uniform(0.35, 0.6), height = random.uniform(0.25, 0.4);
    out.lower_left = vector(0.1) - R * Vec3(width / 2, height / 2, 0);
    out.lower_right = out.lower_left + R * Vec3(width, 0, 0);
    out.upper_left = out.lower_left + R * Vec3(0, height, 0);
    out.mirrored = static_cast<display::Mirrored>(i % 3);
    out.stereo = static_cast<display::Stereo>(i % 4);
    out.eyes.position = R * Vec3(0, 0, random.uniform(0.4, 0.7)) + vector(0.2);
    out.eyes.along = R * Vec3::UnitX() + vector(0.2);
    out.eyes.distance = random.uniform(0.05, 0.075);
    return out;
}

/// Where the line from an eye to a point passes through the screen [pixels from the picture's upper
/// left]. Computed from similar triangles, considering mirrors and the parts of the screen that
/// belong to each eye.
Eigen::Vector2d pinhole(const display::Display& display, bool right_eye, const Vec3& p_W) {
    const Vec3 eye = display.stereo == display::Stereo::none ? display.eyes.position
                     : right_eye                             ? display.eyes.right()
                                                             : display.eyes.left();
    const Vec3 n = display.right().cross(display.up()).normalized();
    const double share = n.dot(eye - display.lower_left) / n.dot(eye - p_W);
    const Vec3 at = eye + share * (p_W - eye) - display.lower_left;
    double u = at.dot(display.right()) / display.right().squaredNorm();
    double v = at.dot(display.up()) / display.up().squaredNorm();
    if (display.mirrored == display::Mirrored::left_right) u = 1 - u;
    if (display.mirrored == display::Mirrored::up_down) v = 1 - v;
    if (display.stereo == display::Stereo::side_by_side) u = (u + (right_eye ? 1 : 0)) / 2;
    if (display.stereo == display::Stereo::top_bottom) v = (v + (right_eye ? 0 : 1)) / 2;
    return {u * kWidth, (1 - v) * kHeight};
}

/// Where a pane draws a point in the picture [pixels from the upper left].
Eigen::Vector2d drawn_at(const Pane& pane, const Vec3& p_W) {
    const Eigen::Vector4d clip = pane.viewpoint.clip_from_world * p_W.homogeneous();
    const double u = (clip.x() / clip.w() + 1) / 2, v = (clip.y() / clip.w() + 1) / 2;
    return {(pane.left + pane.width * u) * kWidth, (1 - pane.bottom - pane.height * v) * kHeight};
}

/// A random point in front of or behind the screen, whose images for both eyes are on the screen.
Vec3 random_point(Random& random, const display::Display& display) {
    const Vec3 on_screen = display.lower_left + random.uniform(0.2, 0.8) * display.right() +
                           random.uniform(0.2, 0.8) * display.up();
    return on_screen + random.uniform(-0.2, 0.15) * (display.eyes.position - on_screen);
}

TEST(Panes, PutPointsWhereAPinholeWould) {
    Random random(7, "panes");
    for (int i = 0; i < kDisplays; ++i) {
        const display::Display display = random_display(random, i);
        Diagnostics diagnostics;
        check(display, diagnostics);
        ASSERT_TRUE(diagnostics.problems().empty()) << diagnostics.problems()[0].text();
        const std::vector<Pane> all = panes(display, 1);
        ASSERT_EQ(all.size(), display.stereo == display::Stereo::none ? 1 : 2);
        for (int k = 0; k < 1000; ++k) {
            const Vec3 p_W = random_point(random, display);
            for (size_t eye = 0; eye < all.size(); ++eye)
                EXPECT_LT((drawn_at(all[eye], p_W) - pinhole(display, eye == 1, p_W)).norm(), 1e-8);
        }
    }
}

TEST(Panes, HaveDepthsThatGrowBehindTheScreenAndBefore) {
    Random random(8, "panes");
    for (int i = 0; i < kDisplays; ++i) {
        const display::Display display = random_display(random, i);
        for (const Pane& pane : panes(display, 2)) {
            const Vec3 eye = pane.viewpoint.eye_W;
            const Vec3 way = random_point(random, display) - eye;
            double before = -1;
            for (const double share : {0.1, 0.5, 1.0, 1.5, 2.0}) {
                const Eigen::Vector4d clip =
                    pane.viewpoint.clip_from_world * Vec3(eye + share * way).homogeneous();
                EXPECT_GT(clip.z() / clip.w(), before);
                before = clip.z() / clip.w();
            }
            EXPECT_LT(before, 1);
        }
    }
}

/// Balls at random points, whose images do not overlap for either eye.
Balls balls_before(Random& random, const display::Display& display) {
    Balls out;
    std::vector<Eigen::Vector2d> taken;
    for (int tried = 0; tried < 4000 && out.scene.bodies.size() < 50; ++tried) {
        const Vec3 p_W = random_point(random, display);
        const bool is_free = std::all_of(taken.begin(), taken.end(), [&](const auto& other) {
            return (pinhole(display, false, p_W) - other).norm() > 30 &&
                   (pinhole(display, true, p_W) - other).norm() > 30;
        });
        if (!is_free) continue;
        taken.push_back(pinhole(display, false, p_W));
        taken.push_back(pinhole(display, true, p_W));
        out.add(p_W);
    }
    return out;
}

TEST(Panes, AreDrawnWhereAPinholeWouldForEachEye) {
    const Offscreen offscreen = software_offscreen(kWidth, kHeight);
    Random random(9, "panes");
    int points = 0;
    double worst = 0;
    for (int i = 0; i < kDisplays; ++i) {
        const display::Display display = random_display(random, i);
        const Balls balls = balls_before(random, display);
        SceneView view(balls.scene);
        view.draw(balls.away(), display, kWidth, kHeight);
        const Image empty = offscreen.read();
        view.draw(balls.frame, display, kWidth, kHeight);
        const Image picture = offscreen.read();
        const std::vector<Pane> all = panes(display, 1);
        for (const scene::Body& ball : balls.scene.bodies) {
            for (size_t eye = 0; eye < all.size(); ++eye) {
                const Eigen::Vector2d exact = pinhole(display, eye == 1, ball.position);
                const double off =
                    (middle_of(picture, empty, all[eye].red ? 0 : 1, exact) - exact).norm();
                EXPECT_LT(off, 0.5) << display.name << i << " " << ball.name;
                worst = std::max(worst, off);
                ++points;
            }
        }
    }
    EXPECT_GT(points, 1000);
    RecordProperty("worst_px", number_text(worst));
}

}  // namespace
}  // namespace dihaptic::view::panes_test
