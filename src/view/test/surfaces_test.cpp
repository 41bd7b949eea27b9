// Tests that bodies look as described in their scene, using pinhole cameras and the formulas in
// ../README.md.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "software_renderer.h"
#include "view/colours.h"
#include "view/pick.h"
#include "view/scene_view.h"
#include "view/triangles.h"

namespace dihaptic::view::surfaces_test {
namespace {

constexpr int kSize = 240;

/// A scene with one body that floats in the air.
scene::Scene one_body(const Vec3& size) {
    scene::Scene scene;
    scene.bodies.resize(1);
    scene.bodies[0].name = "block";
    scene.bodies[0].shape = scene::Shape::box(size);
    scene.bodies[0].mass = 0.1;
    scene.bodies[0].finish = scene::Finish::matt;
    return scene;
}

frame::Frame start(const scene::Scene& scene) {
    frame::Frame frame;
    for (const scene::Body& body : scene.bodies) frame.bodies.push_back({body.pose()});
    return frame;
}

Image picture(const scene::Scene& scene, const frame::Frame& frame, const Camera& camera) {
    const Offscreen offscreen = software_offscreen(kSize, kSize);
    SceneView view(scene);
    view.draw(frame, camera, kSize, kSize);
    return offscreen.read();
}

Camera camera_at(const Vec3& position, const Vec3& look_at = Vec3::Zero()) {
    Camera camera;
    camera.position = position;
    camera.look_at = look_at;
    camera.field_of_view = 0.4;
    return camera;
}

scene::Picture worn(Image image, double width) {
    scene::Picture out;
    out.width = width;
    out.image = std::make_shared<const Image>(std::move(image));
    return out;
}

/// Linear red, green and blue light of a pixel.
Vec3 light_at(const Image& image, int x, int y) {
    const uint8_t* const p = image.at(x, y);
    return linear_colour(uint32_t{p[0]} << 16 | uint32_t{p[1]} << 8 | p[2]);
}

Ray ray_of(const Camera& camera, int x, int y) {
    return ray_through(camera, (2 * x + 1.0) / kSize - 1, 1 - (2 * y + 1.0) / kSize);
}

/// A picture of two by two squares, of which the upper right and the lower left are light.
Image checker(int square) {
    Image out{2 * square, 2 * square, {}};
    for (int y = 0; y < 2 * square; ++y) {
        for (int x = 0; x < 2 * square; ++x)
            out.rgb.insert(out.rgb.end(), 3, (x < square) == (y < square) ? 30 : 230);
    }
    return out;
}

/// The picture is a plate with squares of 10 mm. Each pixel must be as light or dark as the point
/// that a pinhole camera would show there, except along the edges of the squares.
TEST(Pictures, HaveTheirEdgesWhereAPinholePutsThem) {
    scene::Scene scene = one_body({0.3, 0.3, 0.01});
    scene::Body& plate = scene.bodies[0];
    plate.position = {0.012, -0.007, 0.02};
    plate.rotation = {0, 0, 0.3};
    plate.picture = worn(checker(40), 0.02);
    const Pose X_BW = plate.pose().inverse();
    for (const Vec3& from : {Vec3(0, 0, 0.4), Vec3(0.2, -0.25, 0.25)}) {
        const Camera camera = camera_at(from);
        const Image image = picture(scene, start(scene), camera);
        const auto place_B = [&](int x, int y) {
            const Ray ray = ray_of(camera, x, y);
            const Vec3 from_B = X_BW * ray.from_W, along_B = X_BW.R * ray.along_W;
            return Vec3(from_B + (0.005 - from_B.z()) / along_B.z() * along_B);
        };
        const auto is_light = [&](int x, int y) {
            const Vec3 p_B = place_B(x, y);
            return std::sin(std::numbers::pi / 0.01 * p_B.x()) *
                       std::sin(std::numbers::pi / 0.01 * p_B.y()) >
                   0;
        };
        int inside = 0;
        for (int y = 1; y + 1 < kSize; ++y) {
            for (int x = 1; x + 1 < kSize; ++x) {
                const bool light = is_light(x, y);
                if (place_B(x, y).cwiseAbs().maxCoeff() > 0.145 || is_light(x - 1, y) != light ||
                    is_light(x + 1, y) != light || is_light(x, y - 1) != light ||
                    is_light(x, y + 1) != light)
                    continue;  // outside the plate, or within one pixel of an edge
                ++inside;
                const double seen = light_at(image, x, y).y();
                ASSERT_TRUE(light ? seen > 0.3 : seen < 0.1) << x << " " << y << " " << seen;
            }
        }
        EXPECT_GT(inside, kSize * kSize / 2);
    }
}

/// On every side of a cube, the picture is upright and not mirrored.
TEST(Pictures, LieOnEachSideAsTheyAreRead) {
    scene::Scene scene = one_body(Vec3::Constant(0.04));
    // red and green above blue and yellow
    scene.bodies[0].picture = worn({2, 2, {200, 0, 0, 0, 200, 0, 0, 0, 200, 200, 200, 0}}, 0.04);
    struct Side {
        Vec3 out, right, up;
    };
    const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
    for (const Side& side : {Side{z, x, y}, Side{-z, x, -y}, Side{x, y, z}, Side{-x, -y, z},
                             Side{y, -x, z}, Side{-y, x, z}}) {
        const Camera camera = camera_at(0.3 * side.out);
        const Image image = picture(scene, start(scene), camera);
        const Eigen::Matrix4d clip = projection(camera, 1, 0.01, 1);
        for (const int right : {-1, 1}) {
            for (const int up : {-1, 1}) {
                const Vec3 p = 0.02 * side.out + 0.01 * (right * side.right + up * side.up);
                const Eigen::Vector4d at = clip * p.homogeneous();
                const Vec3 seen =
                    light_at(image, static_cast<int>((at.x() / at.w() + 1) / 2 * kSize),
                             static_cast<int>((1 - at.y() / at.w()) / 2 * kSize));
                const Vec3 wanted = up > 0 ? (right < 0 ? x : y) : (right < 0 ? z : Vec3(x + y));
                EXPECT_LT((seen / seen.maxCoeff() - wanted).cwiseAbs().maxCoeff(), 0.05)
                    << side.out.transpose() << ": " << seen.transpose();
            }
        }
    }
}

double smoothstep(double low, double high, double at) {
    const double t = std::clamp((at - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// The light from a surface without shadows, according to the formulas in README.md. n is the
/// normal of the surface; v points toward the eye.
Vec3 lit(scene::Finish finish, const Vec3& base, const Vec3& n, const Vec3& v) {
    const Vec3 sky(0.44, 0.47, 0.52), ground(0.29, 0.275, 0.26), key(0.88, 0.85, 0.80);
    const Vec3 l = SceneView::light(), h = (l + v).normalized(), one = Vec3::Ones();
    const auto mix = [](const Vec3& a, const Vec3& b, double t) { return Vec3(a + t * (b - a)); };
    const Vec3 direct = key * std::max(n.dot(l), 0.0);
    const Vec3 r = 2 * n.dot(v) * n - v;
    if (finish == scene::Finish::metal) {
        const auto reflectance = [&](double cosine) {
            return Vec3(base + std::pow(1 - cosine, 5) * (one - base));
        };
        const double side = r.head<2>().dot(l.head<2>().normalized());
        const Vec3 room = mix(ground, (1.7 - 1.4 * smoothstep(0.1, 0.9, r.z())) * sky,
                              smoothstep(-0.25, 0.25, r.z())) *
                          (0.7 + 0.6 * smoothstep(-0.9, 0.9, side));
        return reflectance(n.dot(v)).cwiseProduct(room) +
               reflectance(v.dot(h)).cwiseProduct(direct) * 8.5 * std::pow(n.dot(h), 60);
    }
    const Vec3 diffuse = base.cwiseProduct(mix(ground, sky, 0.5 + 0.5 * n.z()) + direct);
    if (finish == scene::Finish::matt) return diffuse;
    return diffuse +
           (0.04 + 0.96 * std::pow(1 - n.dot(v), 5)) * 0.5 *
               mix(ground, sky, smoothstep(-0.3, 0.7, r.z())) +
           key * 0.35 * std::pow(n.dot(h), 70);
}

TEST(Finishes, ReflectAsTheirFormulasSay) {
    scene::Scene scene = one_body({0.06, 0.06, 0.04});
    for (const char* colour : {"#f5e4ae", "#3b7dd8"}) {
        scene.bodies[0].colour = colour;
        for (const Vec3& from : {Vec3(0, 0, 0.3), Vec3(0.1, 0.1, 0.25), Vec3(0.2, -0.15, 0.12)}) {
            const Camera camera = camera_at(from, {0, 0, 0.02});
            const Vec3 v = -ray_of(camera, kSize / 2, kSize / 2).along_W;
            for (const auto finish :
                 {scene::Finish::satin, scene::Finish::matt, scene::Finish::metal}) {
                scene.bodies[0].finish = finish;
                const Vec3 seen =
                    light_at(picture(scene, start(scene), camera), kSize / 2, kSize / 2);
                const Vec3 wanted =
                    lit(finish, linear_colour(colour), Vec3::UnitZ(), v).cwiseMin(1);
                EXPECT_LT((seen - wanted).cwiseAbs().maxCoeff(), 0.012)
                    << enum_name(finish) << " " << colour << " from " << from.transpose() << ": "
                    << seen.transpose() << ", not " << wanted.transpose();
            }
        }
    }
}

/// A flat mesh of two triangles, with one colour on the left and another on the right; without
/// colours if both are -1.
std::shared_ptr<const scene::Mesh> flag(int32_t left, int32_t right) {
    scene::Mesh mesh;
    mesh.vertices = {{-0.03, -0.03, 0}, {0.03, -0.03, 0}, {0.03, 0.03, 0}, {-0.03, 0.03, 0}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    if (left >= 0 || right >= 0) mesh.colours = {left, right, right, left};
    return std::make_shared<const scene::Mesh>(mesh);
}

TEST(OwnColours, OfAMeshAreDrawnAsLightThatIsMixedBetweenItsVertices) {
    scene::Scene scene = one_body({0.02, 0.02, 0.02});
    scene.bodies[0].seen = scene::SeenMesh{};
    scene.bodies[0].seen->mesh = flag(0xd55e00, 0x0072b2);
    const Camera camera = camera_at({0, 0, 0.3});
    const Image image = picture(scene, start(scene), camera);
    const Vec3 left = linear_colour(0xd55e00), right = linear_colour(0x0072b2);
    for (const int x : {70, 120, 170}) {
        const Ray ray = ray_of(camera, x, 120);
        const double share =
            (ray.from_W - ray.from_W.z() / ray.along_W.z() * ray.along_W).x() / 0.06 + 0.5;
        const Vec3 wanted =
            lit(scene::Finish::matt, left + share * (right - left), Vec3::UnitZ(), -ray.along_W);
        EXPECT_LT((light_at(image, x, 120) - wanted).cwiseAbs().maxCoeff(), 0.012) << x;
    }
}

TEST(OwnColours, AreOfVerticesThatHaveOneAndOthersHaveTheBodys) {
    scene::Shape mesh;
    mesh.kind = scene::ShapeKind::mesh;
    mesh.coloured = flag(0xd55e00, -1);
    scene::Scene scene = one_body({0.02, 0.02, 0.02});
    scene::Shape& whole = scene.bodies[0].shape;
    whole.kind = scene::ShapeKind::compound;
    whole.parts.resize(2);
    whole.parts[0].shape = scene::Shape::box({0.04, 0.04, 0.001});
    whole.parts[0].position = {0, 0.06, 0};
    whole.parts[1].shape = mesh;
    const Triangles all = triangles(scene.bodies[0]);
    ASSERT_EQ(all.colours.size(), all.vertices.size());
    for (size_t i = 0; i < all.vertices.size(); ++i) {
        const bool has_one = all.vertices[i].p.x() < -0.025F;
        ASSERT_EQ(all.colours[i].allFinite(), has_one);
        if (!has_one) continue;
        ASSERT_NEAR(all.colours[i].x(), linear_colour(0xd55e00).x(), 1e-6);
    }
    const Vec3 base = body_colour(scene, 0);
    const Camera camera = camera_at({0, 0, 0.5});
    const Image image = picture(scene, start(scene), camera);
    const Eigen::Vector4d at = projection(camera, 1, 0.01, 1) * Vec3(0, 0.06, 0).homogeneous();
    const int y = static_cast<int>((1 - at.y() / at.w()) / 2 * kSize);
    const Vec3 v = -ray_of(camera, kSize / 2, y).along_W;
    EXPECT_LT((light_at(image, kSize / 2, y) - lit(scene::Finish::matt, base, Vec3::UnitZ(), v))
                  .cwiseAbs()
                  .maxCoeff(),
              0.012);
}

/// A colour given by a task replaces any other appearance of a body.
TEST(OwnColours, AndPicturesGiveWayToATasksColour) {
    const Camera camera = camera_at({0.05, -0.2, 0.2});
    const auto pictures_differ = [&](const std::function<void(scene::Body&)>& look) {
        scene::Scene scene = one_body({0.06, 0.06, 0.02}), plain = scene;
        plain.bodies[0].colour = "#00a000";
        look(plain.bodies[0]);
        look(scene.bodies[0]);
        frame::Frame frame = start(scene);
        EXPECT_NE(picture(scene, frame, camera).rgb, picture(plain, frame, camera).rgb);
        frame.task.looks = {{0, 0, 0x00a000, 1}};
        return picture(scene, frame, camera).rgb != picture(plain, frame, camera).rgb;
    };
    EXPECT_FALSE(pictures_differ([](scene::Body& body) {
        if (body.colour.empty()) body.picture = worn(checker(8), 0.02);
    }));
    EXPECT_FALSE(pictures_differ([](scene::Body& body) {
        body.finish = scene::Finish::metal;
        if (body.colour.empty()) body.picture = worn(checker(8), 0.02);
    }));
    EXPECT_FALSE(pictures_differ([](scene::Body& body) {
        body.seen = scene::SeenMesh{};
        body.seen->mesh = body.colour.empty() ? flag(0xd55e00, 0x0072b2) : flag(-1, -1);
    }));
}

TEST(SeenMeshes, AreDrawnAndPointedAtInPlaceOfTheShape) {
    scene::Scene scene = one_body({0.02, 0.02, 0.02});
    scene.bodies[0].seen = scene::SeenMesh{};
    scene.bodies[0].seen->mesh = flag(-1, -1);
    const Ray beside{{0.02, 0.02, 0.3}, -Vec3::UnitZ()};
    ASSERT_TRUE(seen_first(scene, start(scene), beside));
    EXPECT_EQ(seen_first(scene, start(scene), beside)->body, 0u);
    scene.bodies[0].seen.reset();
    EXPECT_FALSE(seen_first(scene, start(scene), beside));
}

}  // namespace
}  // namespace dihaptic::view::surfaces_test
