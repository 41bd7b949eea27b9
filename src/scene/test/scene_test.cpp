#include "scene/scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "scene/finger_set.h"
#include "scene/mesh.h"
#include "testing/files.h"

namespace dihaptic::scene::scene_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Vertices of a box with opposite corners at 0 and `size`.
std::vector<Vec3> corners(const Vec3& size) {
    std::vector<Vec3> out;
    for (int i = 0; i < 8; ++i)
        out.push_back(size.cwiseProduct(Vec3(i & 1, i >> 1 & 1, i >> 2 & 1)));
    return out;
}

TEST(Hull, OfABoxWithPointsInsideHasItsVolumeAndInertia) {
    std::vector<Vec3> points = corners({0.04, 0.06, 0.1});
    points.emplace_back(0.02, 0.03, 0.05);
    const Hull hull = convex_hull(points);
    EXPECT_EQ(hull.vertices.size(), 8u);
    const VolumeIntegrals mine = integrate(hull.vertices, hull.faces);
    const VolumeIntegrals box = integrate(Shape::box({0.04, 0.06, 0.1}));
    EXPECT_NEAR(mine.volume, box.volume, 1e-15);
    EXPECT_LT((mine.centre - Vec3(0.02, 0.03, 0.05)).norm(), 1e-14);
    EXPECT_LT((mine.inertia - box.inertia).norm(), 1e-18);
}

TEST(Hull, OfPointsInAPlaneIsEmpty) {
    EXPECT_TRUE(convex_hull(corners({1, 1, 0})).faces.empty());
}

TEST(Hull, HasAllPointsBehindEachFaceHoweverNearTheyAre) {
    // corners that lie on lines and in planes, and corners that are between nanometres and tenths
    // of a millimetre apart
    std::mt19937 random(7);
    const auto draw = [&](int from, int to) {
        return std::uniform_int_distribution<>(from, to)(random);
    };
    for (int trial = 0; trial < 400; ++trial) {
        SCOPED_TRACE(trial);
        std::vector<Vec3> points;
        const double grain = std::pow(10, -draw(4, 9));
        for (int i = draw(8, 30); i > 0; --i) {
            const Vec3 coarse = 0.01 * Vec3(draw(0, 4), draw(0, 4), draw(0, 4));
            points.push_back(coarse + grain * Vec3(draw(0, 1), draw(0, 1), draw(0, 1)));
        }
        const Hull hull = convex_hull(points);
        if (hull.faces.empty()) continue;
        for (const std::vector<int>& face : hull.faces) {
            Vec3 area = Vec3::Zero();
            const auto corner = [&](size_t i) {
                return hull.vertices[static_cast<size_t>(face[i % face.size()])];
            };
            for (size_t i = 1; i + 1 < face.size(); ++i)
                area += (corner(i) - corner(0)).cross(corner(i + 1) - corner(0));
            ASSERT_GT(area.norm(), 0);
            for (const Vec3& p : points)
                ASSERT_LT(area.normalized().dot(p - corner(0)), 1e-8) << face.size();
        }
        std::map<std::pair<int, int>, int> sides;
        for (const std::vector<int>& face : hull.faces) {
            for (size_t i = 0; i < face.size(); ++i) {
                const int a = face[i];
                const int b = face[(i + 1) % face.size()];
                sides[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
            }
        }
        for (const auto& [side, balance] : sides) ASSERT_EQ(balance, 0);
    }
}

TEST(Integrals, OfRoundShapesAgreeWithTheirFinePolyhedra) {
    // a capsule, represented as a surface of revolution with many facets
    Shape capsule;
    capsule.kind = ShapeKind::capsule;
    capsule.radius = 0.01;
    capsule.length = 0.03;
    std::vector<Vec3> points;
    for (int ring = -60; ring <= 60; ++ring) {
        const double latitude = kPi / 2 * ring / 60;
        for (int i = 0; i < 120; ++i) {
            const double longitude = 2 * kPi * i / 120;
            const double z = capsule.radius * std::sin(latitude) + (ring > 0   ? 1
                                                                    : ring < 0 ? -1
                                                                               : 0) *
                                                                       capsule.length / 2;
            points.emplace_back(capsule.radius * std::cos(latitude) * std::cos(longitude),
                                capsule.radius * std::cos(latitude) * std::sin(longitude), z);
        }
    }
    const Hull hull = convex_hull(points);
    const VolumeIntegrals fine = integrate(hull.vertices, hull.faces);
    const VolumeIntegrals exact = integrate(capsule);
    EXPECT_NEAR(fine.volume / exact.volume, 1, 2e-3);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(fine.inertia(axis, axis) / exact.inertia(axis, axis), 1, 4e-3);
}

TEST(Integrals, OfSphereAndCylinder) {
    const VolumeIntegrals sphere = integrate(Shape::sphere(0.02));
    EXPECT_NEAR(sphere.volume, 4.0 / 3 * kPi * 8e-6, 1e-18);
    EXPECT_NEAR(sphere.inertia(0, 0) / sphere.volume, 0.4 * 4e-4, 1e-18);
    Shape cylinder;
    cylinder.kind = ShapeKind::cylinder;
    cylinder.radius = 0.01;
    cylinder.length = 0.05;
    const VolumeIntegrals c = integrate(cylinder);
    EXPECT_NEAR(c.inertia(2, 2) / c.volume, 1e-4 / 2, 1e-18);
    EXPECT_NEAR(c.inertia(0, 0) / c.volume, (3e-4 + 25e-4) / 12, 1e-18);
}

Shape cone(double radius, double height) {
    Shape out;
    out.kind = ShapeKind::cone;
    out.radius = radius;
    out.length = height;
    return out;
}

TEST(Integrals, OfAConeAreThoseOfItsClosedFormAndOfItsFinePolyhedron) {
    const double r = 0.02, h = 0.06;
    const VolumeIntegrals exact = integrate(cone(r, h));
    EXPECT_NEAR(exact.volume, kPi * r * r * h / 3, 1e-18);
    EXPECT_NEAR(exact.centre.z(), h / 4 - h / 2, 1e-15);
    EXPECT_NEAR(exact.inertia(2, 2) / exact.volume, 0.3 * r * r, 1e-18);
    EXPECT_NEAR(exact.inertia(0, 0) / exact.volume, 0.15 * r * r + 3.0 / 80 * h * h, 1e-18);
    std::vector<Vec3> points{{0, 0, h / 2}};
    constexpr int kSides = 400;
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * kPi * i / kSides;
        points.emplace_back(r * std::cos(angle), r * std::sin(angle), -h / 2);
    }
    const Hull hull = convex_hull(points);
    const VolumeIntegrals fine = integrate(hull.vertices, hull.faces);
    EXPECT_NEAR(fine.volume / exact.volume, 1, 2e-4);
    EXPECT_LT((fine.centre - exact.centre).norm(), 1e-6);
    EXPECT_LT((fine.inertia - exact.inertia).norm(), 5e-4 * exact.inertia.norm());
}

TEST(Depth, OfAConeIsFromTheNearestOfSideAndBase) {
    // a cone with sides in the ratio 3 : 4 : 5, so that the distances of these points from its side
    // are whole numbers
    const Shape shape = cone(0.03, 0.04);
    EXPECT_NEAR(depth(shape, {0, 0, 0.02}), 0, 1e-15);
    EXPECT_NEAR(depth(shape, {0.03, 0, -0.02}), 0, 1e-15);
    EXPECT_NEAR(depth(shape, {0, 0, 0}), 0.012, 1e-15);
    EXPECT_NEAR(depth(shape, {0, 0, -0.019}), 0.001, 1e-15);
    EXPECT_NEAR(depth(shape, {0, 0, -0.025}), -0.005, 1e-15);
    EXPECT_NEAR(depth(shape, Vec3(0, 0.015, 0) + 0.01 * Vec3(0, 0.8, 0.6)), -0.01, 1e-15);
    const Bounds box = bounds(shape);
    EXPECT_EQ(box.low, Vec3(-0.03, -0.03, -0.02));
    EXPECT_EQ(box.high, Vec3(0.03, 0.03, 0.02));
    for (const Vec3& p : marks(shape)) EXPECT_GT(depth(shape, p), -1e-15);
}

TEST(PairFriction, IsWhatTheFileSaysOfThePairOrElseTheGeometricMean) {
    Scene scene;
    scene.pairs = {{{"thumb", "block"}, 0.35, {}, {}}};
    EXPECT_DOUBLE_EQ(pair_friction(scene, "block", 0.8, "table", 0.8), 0.8);
    EXPECT_DOUBLE_EQ(pair_friction(scene, "block", 0.9, "table", 0.4), 0.6);
    EXPECT_EQ(pair_friction(scene, "block", 0.8, "thumb", 0.8), 0.35);
    EXPECT_EQ(pair_friction(scene, "block", 0, "table", 0.8), 0);
}

TEST(PairSurface, FollowsFromTheTwoSurfaces) {
    const Scene scene;
    Surface sponge, foam, ball, ice;
    sponge.stiffness = 300;
    sponge.damping = 3;
    foam.stiffness = 600;
    ball.restitution = 0.7;
    ice.dynamic_friction = 0.1;
    ice.film = 2;
    const auto pair = [&](double friction_a, const Surface& a, double friction_b,
                          const Surface& b) {
        return pair_surface(scene, {"a", friction_a, a}, {"b", friction_b, b});
    };
    EXPECT_FALSE(pair(0.5, {}, 0.5, {}).is_soft());
    EXPECT_TRUE(pair(0.5, {}, 0.5, ball).slides_like_coulomb());
    EXPECT_DOUBLE_EQ(pair(0.5, sponge, 0.5, {}).stiffness, 300);
    EXPECT_DOUBLE_EQ(pair(0.5, sponge, 0.5, {}).damping, 3);
    // a force that grows by 1 N/s presses the sponge in at 1/300 m/s, which its damper resists
    EXPECT_DOUBLE_EQ(pair(0.5, sponge, 0.5, foam).stiffness, 200);
    EXPECT_DOUBLE_EQ(pair(0.5, sponge, 0.5, foam).damping, 3 * 4.0 / 9);
    EXPECT_DOUBLE_EQ(pair(0.5, ball, 0.5, {}).restitution, 0.7);
    EXPECT_DOUBLE_EQ(pair(0.9, ice, 0.4, {}).dynamic_friction, 0.2);
    EXPECT_DOUBLE_EQ(pair(0.9, ice, 0.4, {}).friction, 0.6);
    EXPECT_DOUBLE_EQ(pair(0.9, ice, 0.4, ice).film, 4);
}

TEST(PairSurface, IsWhatTheFileSaysOfThePair) {
    Scene scene;
    Pair pair;
    pair.between = {"b", "a"};
    pair.friction = 0.3;
    pair.surface.restitution = 0.2;
    pair.surface.stiffness = 1000;
    scene.pairs = {pair};
    Surface own;
    own.restitution = 0.9;
    own.dynamic_friction = 0.25;
    const PairSurface surface = pair_surface(scene, {"a", 0.5, own}, {"b", 0.5, own});
    EXPECT_EQ(surface.restitution, 0.2);
    EXPECT_EQ(surface.stiffness, 1000);
    EXPECT_EQ(surface.friction, 0.3);
    EXPECT_EQ(surface.dynamic_friction, 0.3);
}

TEST(PairSurface, FallsByStribecksCurveAndRisesByItsFilm) {
    PairSurface surface;
    surface.friction = 0.6;
    surface.dynamic_friction = 0.4;
    surface.stribeck_speed = 0.05;
    EXPECT_DOUBLE_EQ(surface.friction_at(0, 1), 0.6);
    EXPECT_NEAR(surface.friction_at(0.05, 1), 0.4 + 0.2 / std::numbers::e, 1e-12);
    EXPECT_NEAR(surface.friction_at(1, 1), 0.4, 1e-12);
    surface.film = 3;
    EXPECT_NEAR(surface.friction_at(1, 2), 0.4 + 1.5, 1e-12);
    EXPECT_NEAR(surface.friction_at(1, 0), 0.4, 1e-12);
}

/// The messages reported when the scene is read.
std::string problems_of(const std::string& yaml) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    read_scene(folder.write("scene.yaml", yaml), diagnostics);
    std::string all;
    for (const Problem& p : diagnostics.problems()) all += p.text() + "\n";
    return all;
}

const std::string kBlock =
    "bodies:\n  - {name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100}\n";

TEST(SceneFile, ReadsAndFillsInTwoPads) {
    EXPECT_EQ(problems_of(kBlock), "");
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    const Scene scene = read_scene(folder.write("scene.yaml", kBlock), diagnostics);
    ASSERT_EQ(scene.fingers.size(), 2u);
    EXPECT_EQ(scene.fingers[0].name, "thumb");
    EXPECT_EQ(scene.object_index(), 0);
    EXPECT_EQ(mass(scene.bodies[0]), 0.1);
}

TEST(SceneFile, MassFromDensity) {
    Body body;
    body.shape = Shape::box({0.1, 0.1, 0.1});
    body.density = 800;
    EXPECT_NEAR(mass(body), 0.8, 1e-15);
}

struct Bad {
    const char* yaml;
    const char* says;
};
void PrintTo(const Bad& bad, std::ostream* out) {
    *out << bad.says;
}
class BadScene : public ::testing::TestWithParam<Bad> {};
TEST_P(BadScene, IsReported) {
    EXPECT_NE(problems_of(GetParam().yaml).find(GetParam().says), std::string::npos)
        << problems_of(GetParam().yaml);
}
INSTANTIATE_TEST_SUITE_P(
    SceneFile, BadScene,
    ::testing::Values(
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 100,\n     surface: "
            "{damping_Ns_m: 3}}\n",
            "scene.yaml:3: error: damping: needs a stiffness"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 100, surface: "
            "{stiffness_N_m: 500, restitution: 0.5}}\n",
            "restitution: cannot be combined with a stiffness"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 100, surface: "
            "{stiffness_N_m: 5}}\n",
            "stiffness_N_m: must be at least 50"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 100, surface: "
            "{restitution: 1.5}}\n",
            "restitution: must be"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 100, friction: 0.4, "
            "surface: {dynamic_friction: 0.5}}\n",
            "dynamic_friction: is above the static coefficient of 0.4"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 400, surface: "
            "{stiffness_N_m: 200}}\n",
            "lets b sink by 19.6 mm under its own weight; its thickness is 40 mm"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 400}\npairs:\n  - "
            "{between: [b, thumb]}\n",
            "friction: is missing, and there is no surface"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 400}\njoints:\n  - "
            "{name: j, kind: hinge, between: [b], low_deg: 5, high_deg: 50}\n",
            "warning: low: j starts at 0 deg, beyond its stop at 5"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 400}\njoints:\n  - "
            "{name: j, kind: distance, between: [b], position_mm: [0, 0, 0], second_position_mm: "
            "[0, 0, 90], high_mm: 50}\n",
            "warning: high: j starts at 90 mm, beyond its stop at 50"},
        Bad{"bodies:\n  - {name: a, shape: box, size_mm: [40, 40, 40], mass_g: 0.002}\n  - {name: "
            "b, "
            "shape: box, size_mm: [40, 40, 40], mass_g: 15000}\njoints:\n  - {name: j, kind: "
            "hinge, "
            "between: [a, b]}\n",
            "a ratio above 1e+06"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], driven: yes, mass_g: 4}\n",
            "mass: does not apply to a driven body"},
        Bad{"title: x\n", "bodies: is missing"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: -100}\n",
            "scene.yaml:2: error: mass_g: must be positive, but is -100"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 9, colour: "
            "reddish}\n",
            "scene.yaml:2: error: colour: 'reddish' is not a colour. Write red, green and blue in"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 9, colour: "
            "'#d0303'}\n",
            "colour: '#d0303' is not a colour"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40]}\n",
            "has neither mass nor density"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_g: 1, density_g_cm3: "
            "1}\n",
            "both mass and density"},
        Bad{"bodies:\n  - {name: b, shape: box, size_m: [40, 40, 40], mass_g: 100}\n",
            "warning: this shape measures 40 m. Check the unit"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [40, 40, 40], mass_kg: 100}\n",
            "warning: b: weighs 100 kg. Check the unit"},
        Bad{"bodies:\n  - {name: b, shape: ball, size_mm: [4, 4, 4], mass_g: 1}\n",
            "'ball' is not known. Use box, sphere"},
        Bad{"bodies:\n  - {name: b, shape: sphere, size_mm: [4, 4, 4], mass_g: 1}\n",
            "radius: is missing"},
        Bad{"bodies:\n  - {name: p, shape: plane}\n", "a plane is infinite and cannot move"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [4, 4, 4], mass_g: 1, turns: xy}\n",
            "cannot turn about exactly two axes"},
        Bad{"bodies:\n  - {name: b, shape: mesh, file: gone.obj, unit: mm, mass_g: 1}\n",
            "there is no mesh"},
        Bad{"bodies:\n  - {name: b, shape: mesh, file: scene.yaml, unit: mm, mass_g: 1}\n",
            "cannot be read"},
        Bad{"bodies:\n  - {name: b, shape: mesh, file: m.obj, mass_g: 1}\n", "unit: is missing"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [4, 4, 4], mass_g: 1}\n  - {name: b, "
            "shape: box, size_mm: [4, 4, 4], mass_g: 1}\n",
            "'b' is used twice"},
        Bad{"bodies:\n  - {name: block, shape: box, size_mm: [4, 4, 4], mass_g: 1}\npairs:\n  - "
            "{between: [blokc, thumb], friction: 1}\n",
            "there is no body or finger 'blokc'. Did you mean block?"},
        Bad{"bodies:\n  - {name: block, shape: box, size_mm: [4, 4, 4], mass_g: 1}\npairs:\n  - "
            "{between: [block], friction: 1}\n",
            "must be two names"},
        Bad{"bodies:\n  - {name: block, shape: box, size_mm: [4, 4, 4], mass_g: 1}\nobject: blok\n",
            "Did you mean block?"},
        Bad{"bodies:\n  - {name: b, shape: box, size_mm: [4, 4, 4], mass_g: 1, friction: -1}\n",
            "friction: must be at least 0"},
        Bad{"bodies: []\n", "scene.yaml:1: error: bodies: there are none"},
        Bad{"fingers: []\nbodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n",
            "scene.yaml:1: error: fingers: there are none"},
        Bad{"bodies:\n  - {name: '', shape: sphere, radius_mm: 4, mass_g: 1}\n",
            "scene.yaml:2: error: name: is empty"},
        Bad{"bodies:\n  - {name: a/b, shape: sphere, radius_mm: 4, mass_g: 1}\n",
            "scene.yaml:2: error: name: 'a/b' cannot be a name"},
        Bad{"bodies:\n  - {name: .., shape: sphere, radius_mm: 4, mass_g: 1}\n",
            "'..' cannot be a name"},
        Bad{"bodies:\n  - {name: thumb, shape: sphere, radius_mm: 4, mass_g: 1}\n",
            "'thumb' is used twice"},
        Bad{"bodies:\n  - {name: thumb_proxy, shape: sphere, radius_mm: 4, mass_g: 1}\n",
            "'thumb_proxy' is the name of another object's part in recordings"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, fixed: yes}\nobject: b\n",
            "scene.yaml:3: error: object: 'b' is fixed"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\nobject: something\n",
            "scene.yaml:3: error: object: there is no body or finger 'something'. There are thumb"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\nobject: thumb\n",
            "object: 'thumb' is a finger"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\npairs:\n  - {between: "
            "[b, b], friction: 1}\n",
            "scene.yaml:4: error: between: 'b' cannot touch itself"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\npairs:\n  - {between: "
            "[b, thumb], friction: 1}\n  - {between: [thumb, b], friction: 0.5}\n",
            "scene.yaml:5: error: between: the pair of b and thumb is given twice"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: [b, "
            "tt]}\n",
            "there is no body 'tt'. Did you mean t?"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: [b, "
            "b]}\n",
            "'b' cannot be joined to itself"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: "
            "[t]}\n",
            "joins no body that can move"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: [b, "
            "t, b]}\n",
            "must contain one or two bodies"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: [b], "
            "axis: [0, 0, 0]}\n",
            "axis: has no direction"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: [b], "
            "low_deg: 10, high_deg: -10}\n",
            "is above 'high'"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: [b], "
            "low_mm: 10}\n",
            "is not a unit of angle"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\njoints:\n  - {name: "
            "j, "
            "kind: distance, between: [b]}\n",
            "second_position: is missing"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\njoints:\n  - {name: "
            "j, "
            "kind: hinge, between: [b], second_position_mm: [0, 0, 9]}\n",
            "belongs to a distance joint"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\njoints:\n  - {name: "
            "j, "
            "kind: distance, between: [b], second_position_mm: [0, 0, 0]}\n",
            "so the rod has no direction"},
        Bad{"bodies:\n  - {name: b_angular, shape: sphere, radius_mm: 4, mass_g: 1}\njoints:\n  - "
            "{name: b, kind: ball, between: [b_angular]}\n",
            "is the name of another object's part in recordings"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: "
            "[b]}\n  - {name: j, kind: ball, between: [b, t]}\n",
            "'j' is used twice"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: "
            "[b]}\n  - {name: k, kind: ball, between: [b, t], stiffness_Nm_rad: 1}\n",
            "no single axis"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: "
            "[b]}\n  - {name: k, kind: universal, between: [b, t], axis: [1, 0, 0]}\n",
            "lies along the first axis"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n  - {name: t, shape: "
            "sphere, radius_mm: 4, fixed: yes}\njoints:\n  - {name: j, kind: hinge, between: "
            "[b]}\n  - {name: k, kind: hing, between: [b, t]}\n",
            "'hing' is not known. Use hinge, slider"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_m: 1e-9, mass_g: 1}\n",
            "radius_m: must be at least 0.0001 and at most 100, but is 1e-9"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1e-30}\n",
            "mass_g: must be at least 0.001 and at most 1000000, but is 1e-30"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1, position_mm: [0, 0, "
            "1e20]}\n",
            "position_mm: must be at least -100000 and at most 100000, but is 1e20"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 0.1, density_g_cm3: 1}\n",
            "b: weighs 4.18879e-09 kg"},
        Bad{"bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\n---\nbodies: []\n",
            "scene.yaml:4: error: a second YAML document starts here"}));

TEST(SceneFile, ANameThatNoRecordingCanHaveIsAnError) {
    const auto named = [](size_t length) {
        return problems_of("bodies:\n  - {name: " + std::string(length, 'b') +
                           ", shape: sphere, radius_mm: 4, mass_g: 1}\n");
    };
    EXPECT_EQ(named(200), "");
    EXPECT_NE(named(201).find(
                  "scene.yaml:2: error: name: has 201 bytes. Choose a name of at most 200 bytes."),
              std::string::npos);
}

/// Returns a scene with `count` fingers; the function below returns one with as many bodies.
std::string scene_with_fingers(size_t count) {
    std::string out = kBlock + "fingers:\n";
    for (size_t i = 0; i < count; ++i)
        out += fmt::format("  - {{name: f{}, shape: sphere, radius_mm: 5}}\n", i);
    return out;
}
std::string scene_with_bodies(size_t count) {
    std::string out = "bodies:\n";
    for (size_t i = 0; i < count; ++i)
        out += fmt::format("  - {{name: b{}, shape: sphere, radius_mm: 5, mass_g: 1}}\n", i);
    return out;
}

TEST(SceneFile, MoreFingersOrBodiesThanASceneMayHaveAreToldWhereTheyBegin) {
    EXPECT_EQ(problems_of(scene_with_fingers(kMostFingers)), "");
    EXPECT_NE(problems_of(scene_with_fingers(kMostFingers + 1))
                  .find(fmt::format("scene.yaml:{}: error: fingers: there are 257, but at most "
                                    "256 are allowed",
                                    kMostFingers + 4)),
              std::string::npos)
        << problems_of(scene_with_fingers(kMostFingers + 1));
    const std::string said = problems_of(scene_with_bodies(20'000));
    EXPECT_NE(
        said.find("scene.yaml:4002: error: bodies: there are 20000, but at most 4000 are allowed"),
        std::string::npos)
        << said;
}

TEST(SceneFile, NamesThatAreNotThereAreToldUpToAHundredThousandOfThem) {
    std::string scene = scene_with_bodies(1000) + "pairs:\n";
    for (int i = 0; i < 1000; ++i)
        scene += fmt::format("  - {{between: [b{}, nobody{}], friction: 0.5}}\n", i, i);
    const std::string said = problems_of(scene);
    EXPECT_NE(said.find("there is no body or finger 'nobody0'"), std::string::npos);
    EXPECT_NE(said.find("there are more problems than those above"), std::string::npos);
    EXPECT_LT(std::count(said.begin(), said.end(), '\n'), 300);
}

TEST(SceneFile, ABodyThatIsCalledAsAFingerThatTheFileLeavesOutIsToldWithItsLine) {
    const std::string said =
        problems_of("bodies:\n  - {name: thumb, shape: sphere, radius_mm: 5, mass_g: 1}\n");
    EXPECT_NE(said.find("scene.yaml:2: error: name: 'thumb' is used twice"), std::string::npos)
        << said;
    EXPECT_NE(said.find("where fingers are left out, they are called thumb and index"),
              std::string::npos)
        << said;
}

TEST(SceneFile, ABadMassIsOneError) {
    for (const char* mass : {"mass_g: -5", "mass_g: x", "mass: 5", "density_g_cm3: 0"}) {
        const std::string said = problems_of(
            std::string("bodies:\n  - {name: b, shape: sphere, radius_mm: 4, ") + mass + "}\n");
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    }
}

TEST(SceneFile, WarnsOfABodyInsideAFixedOne) {
    const std::string table =
        "  - {name: table, shape: box, size_mm: [400, 400, 50], position_mm: [0, 0, -25], fixed: "
        "yes}\n";
    const std::string plane = "  - {name: floor, shape: plane, fixed: yes}\n";
    for (const std::string& fixed : {table, plane}) {
        const auto said_at = [&](const std::string& block) {
            return problems_of("bodies:\n" + fixed + "  - {name: block, mass_g: 100, " + block +
                               "}\n");
        };
        EXPECT_EQ(said_at("shape: box, size_mm: [40, 40, 40], position_mm: [0, 0, 20]"), "");
        EXPECT_EQ(said_at("shape: cylinder, radius_mm: 20, length_mm: 40, position_mm: [0, 0, 20]"),
                  "");
        for (const char* sunk :
             {"shape: box, size_mm: [40, 40, 40]", "shape: sphere, radius_mm: 20",
              "shape: box, size_mm: [90, 9, 40]", "shape: capsule, radius_mm: 10, length_mm: 20",
              "shape: cylinder, radius_mm: 10, length_mm: 40",
              "shape: cone, radius_mm: 10, length_mm: 40"}) {
            EXPECT_NE(said_at(sunk).find("3: warning: block: starts 20 mm deep inside"),
                      std::string::npos)
                << sunk << said_at(sunk);
        }
    }
}

struct BadMesh {
    const char* obj;
    const char* says;
};
void PrintTo(const BadMesh& bad, std::ostream* out) {
    *out << bad.says;
}
class BadMeshFile : public ::testing::TestWithParam<BadMesh> {};
TEST_P(BadMeshFile, IsReportedWithWhatIsMissingAtTheLineOfItsFile) {
    const testing::TemporaryFolder folder;
    folder.write("m.obj", GetParam().obj);
    Diagnostics diagnostics;
    read_scene(folder.write("scene.yaml",
                            "bodies:\n  - name: m\n    shape: mesh\n    file: m.obj\n    unit: "
                            "mm\n    density_g_cm3: 1\n"),
               diagnostics);
    ASSERT_EQ(diagnostics.problems().size(), 1u);
    const std::string said = diagnostics.problems()[0].text();
    EXPECT_NE(said.find("scene.yaml:4: error: file: the mesh"), std::string::npos) << said;
    EXPECT_NE(said.find(GetParam().says), std::string::npos) << said;
}
INSTANTIATE_TEST_SUITE_P(
    SceneFile, BadMeshFile,
    ::testing::Values(
        BadMesh{"v 0 0 0\nv 1 0 0\n", "has 2 vertices ('v') and no faces ('f')"},
        BadMesh{"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", "has 4 vertices ('v') and no faces"},
        BadMesh{"", "has no vertices ('v') and no faces"},
        BadMesh{"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3\nf 2 3 4\nf 1 3 4\nf 1 2 4\n",
                "encloses no volume"},
        BadMesh{"v nan 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
                "m.obj"}));

const char* const kObj =
    "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const char* const kStl =
    "solid t\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 40 0\nvertex 40 0 "
    "0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 40 0 0\nvertex 0 0 "
    "40\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 40\nvertex 0 40 "
    "0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 40 0 0\nvertex 0 40 0\nvertex 0 0 "
    "40\nendloop\nendfacet\n"
    "endsolid t\n";
const char* const kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n40 0 0\n0 40 0\n0 0 40\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

class MeshFormat : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};
TEST_P(MeshFormat, IsReadWithItsUnit) {
    const testing::TemporaryFolder folder;
    const auto [name, text] = GetParam();
    folder.write(name, text);
    const std::string yaml = std::string("bodies:\n  - {name: t, shape: mesh, file: ") + name +
                             ", unit: mm, density_g_cm3: 1}\n";
    Diagnostics diagnostics;
    const Scene scene = read_scene(folder.write("scene.yaml", yaml), diagnostics);
    EXPECT_TRUE(diagnostics.problems().empty());
    EXPECT_NEAR(mass(scene.bodies[0]), 1000 * 0.04 * 0.04 * 0.04 / 6, 1e-9);
}
INSTANTIATE_TEST_SUITE_P(SceneFile, MeshFormat,
                         ::testing::Values(std::pair{"t.obj", kObj}, std::pair{"t.stl", kStl},
                                           std::pair{"t.ply", kPly}));

TEST(SceneFile, WarnsThatAConcaveMeshBecomesItsHull) {
    // an L-shaped compound of two boxes that share a face
    const testing::TemporaryFolder folder;
    folder.write("l.obj",
                 "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                 "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
                 "f 4 3 2 1\nf 6 5 4 1\nf 7 8 9 10\nf 7 10 11 12\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 "
                 "9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n");
    Diagnostics diagnostics;
    read_scene(
        folder.write("scene.yaml",
                     "bodies:\n  - {name: l, shape: mesh, file: l.obj, unit: cm, mass_g: 10}\n"),
        diagnostics);
    ASSERT_EQ(diagnostics.problems().size(), 1u);
    EXPECT_NE(diagnostics.problems()[0].text().find(
                  "is not convex: its convex hull, of 17 % more volume"),
              std::string::npos)
        << diagnostics.problems()[0].text();
}

}  // namespace
}  // namespace dihaptic::scene::scene_test
