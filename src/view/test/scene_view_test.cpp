#include "view/scene_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "software_renderer.h"

#ifdef __SANITIZE_ADDRESS__
/// LeakSanitizer stops all threads to inspect their memory, which fails for Mesa's threads.
extern "C" const char* __asan_default_options();   // NOLINT
extern "C" const char* __asan_default_options() {  // NOLINT
    return "detect_leaks=0";
}
#endif

namespace dihaptic::view::scene_view_test {
namespace {

scene::Body box(const char* name, const Vec3& size, const Vec3& position) {
    scene::Body body;
    body.name = name;
    body.shape = scene::Shape::box(size);
    body.position = position;
    body.mass = 0.1;
    return body;
}

/// A grey table with its top at z = 0, and bodies above it.
scene::Scene on_table(const std::vector<scene::Body>& bodies) {
    scene::Scene scene;
    scene.bodies = {box("table", {0.6, 0.4, 0.05}, {0, 0, -0.025})};
    scene.bodies.front().fixed = true;
    scene.bodies.front().colour = "#b0b0b0";
    scene.bodies.insert(scene.bodies.end(), bodies.begin(), bodies.end());
    return scene;
}

frame::Frame start(const scene::Scene& scene) {
    frame::Frame frame;
    for (const scene::Body& body : scene.bodies) frame.bodies.push_back({body.pose()});
    frame.fingers.resize(scene.fingers.size());
    return frame;
}

Image picture(const scene::Scene& scene, const frame::Frame& frame, const Camera& camera, int width,
              int height, const Overlays& overlays = {}) {
    const Offscreen offscreen = software_offscreen(width, height);
    SceneView view(scene);
    view.draw(frame, camera, width, height, overlays);
    return offscreen.read();
}

/// Linear light in the green channel of a pixel, from 0 to 1, according to the sRGB curve (IEC
/// 61966-2-1).
double light_at(const Image& image, int x, int y) {
    const double s = image.at(x, y)[1] / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

constexpr double kHalfTurn = std::numbers::pi;
constexpr int kPixels = 200;
constexpr double kSpan = 0.16;  // width of the table area shown in pictures [m]

/// A camera close above the table that looks straight down. Bodies higher than 40 mm are behind the
/// camera.
Camera under(const Vec3& p_W) {
    Camera camera;
    camera.look_at = {p_W.x(), p_W.y(), 0};
    camera.position = camera.look_at + Vec3(0, 0, 0.04);
    camera.field_of_view = 2 * std::atan(kSpan / 2 / 0.04);
    return camera;
}

/// Ratio of the light on the table around a point with and without the other bodies, for each
/// pixel; rows are ordered from far to near.
std::vector<double> shares(const scene::Scene& scene, const Vec3& around) {
    const Image image = picture(scene, start(scene), under(around), kPixels, kPixels);
    const scene::Scene bare = on_table({});
    const Image lit = picture(bare, start(bare), under(around), kPixels, kPixels);
    std::vector<double> out;
    for (int y = 0; y < kPixels; ++y) {
        for (int x = 0; x < kPixels; ++x)
            out.push_back(light_at(image, x, y) / light_at(lit, x, y));
    }
    return out;
}

struct Shadow {
    Vec3 centre;      // in W
    double softness;  // width from 20 to 80 % of its depth, along x on its left side [m]
    double darkest;
};

Shadow shadow_of_block_at(double height) {
    const Vec3 p(0, 0, height);
    const scene::Scene scene = on_table({box("block", {0.04, 0.04, 0.04}, p)});
    const Vec3 light = SceneView::light();
    const Vec3 expected = p - light * (height / light.z());
    const std::vector<double> share = shares(scene, expected);
    Shadow out{Vec3::Zero(), 0, 1};
    double sum = 0;
    const double pixel = kSpan / kPixels;
    for (int y = 0; y < kPixels; ++y) {
        for (int x = 0; x < kPixels; ++x) {
            const double dark = 1 - share[static_cast<size_t>(y * kPixels + x)];
            out.darkest = std::min(out.darkest, 1 - dark);
            if (dark < 0.1) continue;
            sum += dark;
            out.centre += dark * Vec3((x + 0.5) * pixel, -(y + 0.5) * pixel, 0);
        }
    }
    out.centre = out.centre / sum + expected + Vec3(-kSpan / 2, kSpan / 2, 0);
    const int row =
        static_cast<int>(std::lround((expected.y() + kSpan / 2 - out.centre.y()) / pixel));
    int soft = 0;
    for (int x = 0; x < kPixels / 2; ++x) {
        const double depth =
            (1 - share[static_cast<size_t>(row * kPixels + x)]) / (1 - out.darkest);
        if (depth > 0.2 && depth < 0.8) ++soft;
    }
    out.softness = soft * pixel;
    return out;
}

TEST(SceneView, TheShadowOfAFloatingBlockMovesAsTheLightHasItAndSoftens) {
    const Vec3 light = SceneView::light();
    double last = 0;
    for (const double height : {0.065, 0.10, 0.16}) {
        const Shadow shadow = shadow_of_block_at(height);
        const Vec3 expected = -light * (height / light.z());
        EXPECT_NEAR(shadow.centre.x(), expected.x(), 0.004) << height;
        EXPECT_NEAR(shadow.centre.y(), expected.y(), 0.004) << height;
        EXPECT_LT(shadow.darkest, 0.6) << height;
        EXPECT_GT(shadow.softness, 1.2 * last) << height;
        last = shadow.softness;
    }
}

/// Under a plate, the table is dark everywhere, even below the edge of another plate higher up.
TEST(SceneView, LittleLightBleedsThroughTwoLayers) {
    const scene::Body lower = box("lower", {0.4, 0.4, 0.004}, {0, 0, 0.06});
    const Vec3 light = SceneView::light();
    const Vec3 middle = lower.position - light * (lower.position.z() / light.z());
    const auto brightest = [&](const std::vector<scene::Body>& bodies) {
        const std::vector<double> all = shares(on_table(bodies), middle);
        return *std::max_element(all.begin(), all.end());
    };
    const double one = brightest({lower});
    EXPECT_LT(one, 0.4);
    // README.md: no light bleeds through until the upper layer is four times as high as the lower
    for (const auto& [height, bound] : {std::pair{0.07, 0.01}, {0.15, 0.01}, {0.25, 0.15}}) {
        const double two = brightest(
            {lower, box("upper", {0.08, 0.08, 0.004}, middle + light * (height / light.z()))});
        EXPECT_LT((two - one) / (1 - one), bound) << height;
    }
}

/// Tilts the table until the light only grazes it.
TEST(SceneView, ATableInGrazingLightHasNoAcne) {
    const Vec3 light = SceneView::light();
    const auto look = [&](double above_horizon) {
        // rotates the table about x until the light is at this angle above the table's horizon
        const double full = std::atan2(light.z(), light.y());
        const double across = std::hypot(light.y(), light.z());
        scene::Scene scene = on_table({});
        scene::Body& table = scene.bodies.front();
        const double angle = full - kHalfTurn / 2 + std::acos(std::sin(above_horizon) / across);
        table.rotation = {angle, 0, 0};
        const Vec3 n = table.pose().R * Vec3::UnitZ();
        EXPECT_NEAR(std::asin(n.dot(light)), above_horizon, 1e-9);
        table.position = -0.025 * n;
        Camera camera;
        camera.look_at = Vec3::Zero();
        camera.position = 0.5 * n;
        camera.field_of_view = 0.3;
        const Image image = picture(scene, start(scene), camera, kPixels, kPixels);
        // uses means over cells of pixels, because a pixel is rounded to one of 256 steps
        constexpr int kCell = 8;
        double least = 1;
        double most = 0;
        double sum = 0;
        for (int y = 0; y < kPixels; y += kCell) {
            for (int x = 0; x < kPixels; x += kCell) {
                double cell = 0;
                for (int i = 0; i < kCell * kCell; ++i)
                    cell += light_at(image, x + i % kCell, y + i / kCell) / (kCell * kCell);
                least = std::min(least, cell);
                most = std::max(most, cell);
                sum += cell;
            }
        }
        return std::array{least, most, sum * kCell * kCell / (kPixels * kPixels)};
    };
    const double dark = look(-0.02)[2];
    for (const double degrees : {3.0, 5.0, 10.0, 20.0}) {
        const auto [least, most, mean] = look(degrees * kHalfTurn / 180);
        // as a share of the light from the main light source
        EXPECT_LT((most - least) / (mean - dark), degrees < 4 ? 0.25 : 0.05) << degrees;
    }
}

std::string reference(const std::string& name) {
    return "src/view/test/" + name + ".png";
}

/// Compares an image with a stored picture. Different renderers may differ by slight noise and in
/// pixels along edges.
void expect_like(const Image& image, const std::string& name) {
    const std::string seen = (std::filesystem::temp_directory_path() / (name + ".png")).string();
    Image stored;
    if (std::filesystem::exists(reference(name))) stored = read_png(reference(name));
    double sum = 0;
    size_t far_off = 0;
    const bool same_size = stored.width == image.width && stored.height == image.height;
    for (size_t i = 0; same_size && i < image.rgb.size(); ++i) {
        const int off = std::abs(image.rgb[i] - stored.rgb[i]);
        sum += off;
        if (off > 24) ++far_off;
    }
    const double mean = sum / static_cast<double>(image.rgb.size());
    const double share = static_cast<double>(far_off) / static_cast<double>(image.rgb.size());
    if (same_size && mean < 1.5 && share < 0.01) return;
    write_png(image, seen);
    ADD_FAILURE() << "mean difference " << mean << " of 255, " << 100 * share
                  << " % far off: look at " << seen << ", and if it is as it should be, copy it to "
                  << reference(name);
}

scene::Scene shipped(const char* file) {
    Diagnostics diagnostics;
    scene::Scene scene = scene::read_scene(file, diagnostics);
    diagnostics.throw_if_errors();
    return scene;
}

/// The shipped block, held between two finger pads.
struct Held {
    scene::Scene scene = shipped("scenes/block-on-table.yaml");
    frame::Frame frame = start(scene);

    explicit Held(double lifted = 0.05) {
        frame.sequence = 1234;
        frame.time = std::chrono::milliseconds(1234);
        const Vec3 p(0, 0, 0.02 + lifted);
        frame.bodies[1].X_WB.p = p;
        for (const int side : {0, 1}) {
            frame::FingerFrame& finger = frame.fingers[static_cast<size_t>(side)];
            const Vec3 out((side - 0.5) * 2, 0, 0);
            finger.p_WP = p + 0.0225 * out;
            finger.p_WH = p + 0.0180 * out;
            frame::ContactFrame contact;
            contact.a = 1;
            contact.b = 2 + side;
            contact.p_WC = p + 0.02 * out;
            contact.f_B_W = out + Vec3(0, 0, -0.49);
            frame.contacts.push_back(contact);
        }
    }
    Camera camera() const { return find_camera(cameras(scene), "front"); }
};

TEST(SceneView, PicturesAreLikeStoredOnes) {
    const Held held;
    expect_like(picture(held.scene, held.frame, held.camera(), 192, 120), "held-block");
    const std::vector<Vec3> path{{0, 0, 0.02}, {0.03, 0, 0.05}, {0, 0, 0.07}};
    const std::array<Workspace, 1> workspaces{Workspace{{}, {0.2, 0.15, 0.16}}};
    Overlays all;
    all.handles = all.forces = all.contacts = all.grip_axis = true;
    all.path = path;
    all.workspaces = workspaces;
    expect_like(picture(held.scene, held.frame, held.camera(), 192, 120, all), "overlays");
    Overlays hand;
    hand.hand = true;
    expect_like(picture(held.scene, held.frame, held.camera(), 192, 120, hand), "hand");
    const scene::Scene tools = shipped("scenes/tools.yaml");
    frame::Frame frame = start(tools);
    for (size_t i = 0; i < frame.fingers.size(); ++i)
        frame.fingers[i].p_WP = Vec3(-0.12 + 0.08 * static_cast<double>(i), -0.08, 0.05);
    expect_like(picture(tools, frame, cameras(tools).front(), 192, 120), "tools");
    const scene::Scene bead = shipped("scenes/bead-on-string.yaml");
    frame = start(bead);
    frame.fingers[0].p_WP = Vec3(0, 0, 0.02);
    expect_like(picture(bead, frame, find_camera(cameras(bead), "side"), 192, 120), "bead");
}

TEST(SceneView, EveryShapeIsDrawn) {
    for (const auto& [kind, name] : {std::pair{scene::ShapeKind::sphere, "sphere"},
                                     {scene::ShapeKind::capsule, "capsule"},
                                     {scene::ShapeKind::cylinder, "cylinder"},
                                     {scene::ShapeKind::cone, "cone"}}) {
        scene::Scene scene = on_table({box(name, {0.04, 0.04, 0.04}, {0, 0, 0.05})});
        scene.bodies[1].shape = scene::Shape::sphere(0.02);
        scene.bodies[1].shape.kind = kind;
        scene.bodies[1].shape.length = 0.03;
        scene.bodies[1].colour = "#0000ff";
        Camera camera;
        camera.look_at = {0, 0, 0.05};
        const Image image = picture(scene, start(scene), camera, 64, 64);
        const uint8_t* middle = image.at(32, 32);
        EXPECT_GT(middle[2], middle[0] + 60) << name;
    }
}

TEST(SceneView, EachOverlayShowsAndLeavesNothing) {
    const Held held;
    const Offscreen offscreen = software_offscreen(192, 120);
    SceneView view(held.scene);
    const auto look = [&](const Overlays& overlays) {
        view.draw(held.frame, held.camera(), 192, 120, overlays);
        return offscreen.read();
    };
    const Image plain = look({});
    const std::vector<Vec3> path{{0, 0, 0.02}, {0, 0, 0.07}};
    const std::array<Workspace, 1> workspaces{Workspace{{}, {0.2, 0.15, 0.16}}};
    std::vector<Overlays> layers(7);
    layers[0].handles = true;
    layers[1].forces = true;
    layers[2].contacts = true;
    layers[3].grip_axis = true;
    layers[4].path = path;
    layers[5].workspaces = workspaces;
    layers[6].picked = 0;
    for (size_t i = 0; i < layers.size(); ++i) {
        const Image with = look(layers[i]);
        size_t changed = 0;
        for (size_t k = 0; k < with.rgb.size(); ++k)
            changed += std::abs(with.rgb[k] - plain.rgb[k]) > 8 ? 1 : 0;
        EXPECT_GT(changed, 20) << i;
    }
    EXPECT_EQ(look({}).rgb, plain.rgb);
}

TEST(SceneView, APickedBodyHasABoxAboutItWhereItIsShown) {
    scene::Scene scene = on_table({box("block", {0.04, 0.06, 0.02}, {0, 0, 0.01})});
    scene.bodies[1].colour = "#b0b0b0";
    frame::Frame frame = start(scene);
    frame.bodies[1].X_WB.p = {0.03, -0.01, 0.05};
    Camera camera;
    camera.position = {0, -0.2, 0.3};
    camera.look_at = frame.bodies[1].X_WB.p;
    Overlays overlays;
    overlays.picked = 1;
    constexpr int kSize = 400;
    const Image plain = picture(scene, frame, camera, kSize, kSize);
    const Image with = picture(scene, frame, camera, kSize, kSize, overlays);
    const Eigen::Matrix4d clip = projection(camera, 1, 0.01, 10);
    // middles of the upper front, rear and right edges of the marking box, 2 mm outside the body
    for (const Vec3& edge :
         {Vec3(0, -0.032, 0.012), Vec3(0, 0.032, 0.012), Vec3(0.022, 0, 0.012)}) {
        const Vec3 p_W = frame.bodies[1].X_WB * edge;
        const Eigen::Vector4d at = clip * p_W.homogeneous();
        const int x = static_cast<int>((at.x() / at.w() + 1) / 2 * kSize);
        const int y = static_cast<int>((1 - at.y() / at.w()) / 2 * kSize);
        EXPECT_GT(with.at(x, y)[0], with.at(x, y)[2] + 60) << edge.transpose();  // orange
        EXPECT_LT(std::abs(plain.at(x, y)[0] - plain.at(x, y)[2]), 40) << edge.transpose();
    }
}

TEST(SceneView, EveryKindOfJointHasAMark) {
    Held held;
    const Offscreen offscreen = software_offscreen(192, 120);
    const auto names = enum_names(scene::JointKind{});
    for (size_t kind = 0; kind < names.size(); ++kind) {
        for (const bool springs : {false, true}) {
            scene::Joint joint;
            joint.kind = static_cast<scene::JointKind>(kind);
            joint.between = {"table", "block"};
            joint.position = {0, 0, 0.05};
            joint.axis = {1, 0, 0};
            joint.second_axis = {0, 1, 0};
            if (joint.is_distance()) joint.second_position = Vec3(0, 0, 0.02);
            if (springs) joint.stiffness = 100;
            held.scene.joints = {joint};
            SceneView view(held.scene);
            const auto look = [&](bool joints) {
                Overlays overlays;
                overlays.joints = joints;
                view.draw(held.frame, held.camera(), 192, 120, overlays);
                return offscreen.read();
            };
            const Image plain = look(false);
            const Image with = look(true);
            size_t changed = 0;
            for (size_t k = 0; k < with.rgb.size(); ++k)
                changed += std::abs(with.rgb[k] - plain.rgb[k]) > 8 ? 1 : 0;
            EXPECT_GT(changed, 5) << names[kind] << " " << springs;
        }
    }
}

TEST(SceneView, StampsWhatItShowsAndLeavesTheTargetBound) {
    const Held held;
    const Offscreen offscreen = software_offscreen(64, 48);
    SceneView view(held.scene);
    for (const int width : {64, 32, 64}) {
        const Shown shown = view.draw(held.frame, held.camera(), width, 48);
        EXPECT_EQ(shown.sequence, 1234);
        EXPECT_EQ(shown.time, std::chrono::milliseconds(1234));
    }
    const Image once = offscreen.read();
    view.draw(held.frame, held.camera(), 64, 48);
    EXPECT_EQ(offscreen.read().rgb, once.rgb);  // nothing of the previous frame must remain
}

/// A body with the position NaN, as in a damaged log, is left out; the other bodies are drawn as
/// usual.
TEST(SceneView, DrawsWhatIsKnown) {
    Held held;
    const Vec3 nan = Vec3::Constant(std::nan(""));
    held.frame.bodies[1].X_WB.p = nan;
    held.frame.contacts.clear();
    const Image without = picture(held.scene, held.frame, held.camera(), 64, 48);
    held.frame.bodies[1].X_WB.p = Vec3(50, 0, 0);
    const Image away = picture(held.scene, held.frame, held.camera(), 64, 48);
    EXPECT_EQ(without.rgb, away.rgb);
}

/// Bodies that an experiment displays at a different position are drawn as if they were there.
TEST(SceneView, DrawsTheDisplayedWorld) {
    const Held held;
    frame::Frame moved = held.frame;
    moved.contacts.clear();
    frame::Frame mapped = moved;
    frame::VisualMap map;
    map.moves = frame::kMovesObject;
    map.object = 1;
    map.scale = {1, 1, 1.25};
    mapped.task.visual.push_back(map);
    moved.bodies[1].X_WB.p.z() *= 1.25;
    EXPECT_EQ(picture(held.scene, mapped, held.camera(), 96, 64).rgb,
              picture(held.scene, moved, held.camera(), 96, 64).rgb);
}

TEST(SceneView, DrawsTargets) {
    Held held;
    const Image without = picture(held.scene, held.frame, held.camera(), 96, 64);
    held.frame.task.targets.push_back({0, {0.06, 0, 0.05}, 0.01});
    const Image with = picture(held.scene, held.frame, held.camera(), 96, 64);
    size_t redder = 0;
    for (size_t i = 0; i < with.rgb.size(); i += 3) redder += with.rgb[i] > with.rgb[i + 1] + 40;
    EXPECT_GT(redder, 20U);
    EXPECT_NE(with.rgb, without.rgb);
}

/// Around the block, a target hides little of it, however large it is; its rim remains visible.
TEST(SceneView, DrawsALargeTargetAsABubble) {
    constexpr int kWidth = 96, kHeight = 64;
    Held held;
    const Camera camera{"", {0, -0.4, 0.07}, {0, 0, 0.07}, 0.6};
    const auto changed = [&](double radius) {
        held.frame.task.targets.clear();
        const Image without = picture(held.scene, held.frame, camera, kWidth, kHeight);
        held.frame.task.targets.push_back({0, {0, 0, 0.07}, radius});
        const Image with = picture(held.scene, held.frame, camera, kWidth, kHeight);
        std::vector<int> out;  // of red, along the middle row
        for (int x = 0; x < kWidth; ++x) {
            const auto i = static_cast<size_t>(3 * (kHeight / 2 * kWidth + x));
            out.push_back(std::abs(with.rgb[i] - without.rgb[i]));
        }
        return out;
    };
    const std::vector<int> small = changed(0.03), large = changed(0.09);
    EXPECT_GT(small[kWidth / 2], 30);
    EXPECT_LT(large[kWidth / 2], small[kWidth / 2] / 2);
    EXPECT_GT(std::ranges::max(large), 1.4 * large[kWidth / 2]);
}

TEST(SceneView, DrawsThePatchInItsCorner) {
    const scene::Scene scene = on_table({});
    constexpr int kWidth = 200, kHeight = 100, kEdge = 20;
    for (const auto corner : {display::Corner::lower_left, display::Corner::lower_right,
                              display::Corner::upper_left, display::Corner::upper_right}) {
        for (const bool white : {false, true}) {
            Overlays overlays;
            overlays.patch = PatchLook{{corner, 0.2}, white};
            const Camera camera = cameras(scene).front();
            const Image plain = picture(scene, start(scene), camera, kWidth, kHeight);
            const Image image = picture(scene, start(scene), camera, kWidth, kHeight, overlays);
            const bool right =
                corner == display::Corner::lower_right || corner == display::Corner::upper_right;
            const bool upper =
                corner == display::Corner::upper_left || corner == display::Corner::upper_right;
            for (int y = 0; y < kHeight; ++y) {
                for (int x = 0; x < kWidth; ++x) {
                    const bool in = (right ? x >= kWidth - kEdge : x < kEdge) &&
                                    (upper ? y < kEdge : y >= kHeight - kEdge);
                    for (int k = 0; k < 3; ++k)
                        ASSERT_EQ(image.at(x, y)[k], in ? (white ? 255 : 0) : plain.at(x, y)[k]);
                }
            }
        }
    }
}

TEST(SceneView, OfLessDetailIsLikeTheWholePicture) {
    const scene::Scene scene = on_table({box("block", Vec3::Constant(0.04), {0, 0, 0.06})});
    const Camera camera = cameras(scene).front();
    const Offscreen offscreen = software_offscreen(320, 240);
    SceneView view(scene);
    const auto drawn = [&](double detail) {
        view.set_detail(detail);
        view.draw(start(scene), camera, 320, 240);
        return offscreen.read();
    };
    const Image whole = drawn(1), coarse = drawn(2.0 / 3), again = drawn(1);
    EXPECT_EQ(whole.rgb, again.rgb);
    double off = 0;
    for (size_t i = 0; i < whole.rgb.size(); ++i) off += std::abs(whole.rgb[i] - coarse.rgb[i]);
    off /= static_cast<double>(whole.rgb.size());
    EXPECT_GT(off, 0.05);
    EXPECT_LT(off, 3);
}

TEST(Image, IsWrittenWholeOrNotAtAll) {
    const Image image{2, 1, {1, 2, 3, 4, 5, 6}};
    const std::string file =
        (std::filesystem::temp_directory_path() / "dihaptic-image-test.png").string();
    write_png(image, file);
    EXPECT_EQ(read_png(file).rgb, image.rgb);
    std::filesystem::remove(file);
    EXPECT_THROW(write_png(image, "/no/such/folder/x.png"), Error);
    EXPECT_THROW(read_png("README.md"), Error);
}

}  // namespace
}  // namespace dihaptic::view::scene_view_test
