// Tests contacts of round shapes: distances are compared with a search over all directions, and
// rolling, lying and sliding bodies with closed forms.
#include "dynamics/round.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "base/number.h"
#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics::round_test {
namespace {

const Polyhedron kBox = Polyhedron::box({0.04, 0.06, 0.03});
const std::vector<Round> kRounds{{0.01},
                                 {0.012, 0.02},
                                 {0.004, 0.05},
                                 {0.02, 0.03, Round::Ends::flat},
                                 {0.03, 0.004, Round::Ends::flat},
                                 {0.003, 0.06, Round::Ends::flat},
                                 {0.02, 0.03, Round::Ends::tip},
                                 {0.03, 0.004, Round::Ends::tip},
                                 {0.003, 0.06, Round::Ends::tip}};

double extent(const Round& shape, const Pose& X_W, const Vec3& u) {
    const double along = (X_W.R * Vec3::UnitZ()).dot(u);
    const double side = shape.has_rim() ? std::sqrt(1 - std::min(1.0, along * along)) : 1;
    if (shape.is_cone())
        return std::max(shape.half * along, shape.radius * side - shape.half * along);
    return shape.half * std::abs(along) + shape.radius * side;
}

double extent(const Polyhedron& shape, const Pose& X_W, const Vec3& u) {
    double out = -1;
    for (const Vec3& v : shape.vertices) out = std::max(out, (X_W.R * v).dot(u));
    return out;
}

/// Distance between convex shapes, i.e. the largest separation along any direction. It is found by
/// random steps of shrinking size, starting from the best of many directions or from the given
/// direction.
template <class A, class B>
double apart(const A& a, const Pose& X_WA, const B& b, const Pose& X_WB, std::mt19937& random,
             const Vec3& start = Vec3::Zero()) {
    std::normal_distribution<> normal;
    const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    const auto along = [&](const Vec3& u) {
        return u.dot(X_WB.p - X_WA.p) - extent(a, X_WA, u) - extent(b, X_WB, -u);
    };
    double best = -1;
    Vec3 axis = Vec3::UnitX();
    const auto look = [&](const Vec3& u) {
        const double found = along(u.normalized());
        if (found <= best) return;
        best = found;
        axis = u.normalized();
    };
    if (!start.isZero()) look(start);
    for (int i = 0; i < 500 && start.isZero(); ++i) look(any());
    for (double size = 0.1; size > 1e-7; size *= 0.8)
        for (int i = 0; i < 60; ++i) look(axis + size * any());
    return best;
}

/// The smallest gap of a patch, or a large number if there is no contact.
double gap(const ContactPatch& patch) {
    double out = 1;
    for (int i = 0; i < patch.count; ++i)
        out = std::min(out, patch.points[static_cast<size_t>(i)].gap);
    return out;
}

/// Moves B towards A or away from it until they are a few tenths of a millimetre apart, as they are
/// in each step, and compares their contacts. `off` is the tolerance [m].
template <class A, class B>
void compare(const A& a, const B& b, double off, std::mt19937& random) {
    std::normal_distribution<> normal;
    std::uniform_real_distribution<> small(-2e-4, 4e-4);
    const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    const Pose X_WA{rotation_by(any()), 0.01 * any()};
    Pose X_WB{rotation_by(any()), {}};
    const Vec3 way = any().normalized();
    X_WB.p = X_WA.p + 0.2 * way;
    const double wanted = small(random);
    for (int i = 0; i < 6; ++i) X_WB.p -= (apart(a, X_WA, b, X_WB, random) - wanted) * way;
    const double right = apart(a, X_WA, b, X_WB, random);
    const double margin = 1e-3;
    if (right > margin) return;  // B has passed A
    ContactPatch patch;
    if constexpr (std::is_same_v<A, Polyhedron>) {
        patch = collide(a, X_WA, b, X_WB, margin, -way);
    } else {
        patch = collide(a, X_WA, b, X_WB, margin);
    }
    ASSERT_GT(patch.count, 0);
    const double about = apart(a, X_WA, b, X_WB, random, patch.n_W);
    EXPECT_NEAR(gap(patch), std::max(right, about), off);
    EXPECT_NEAR(patch.n_W.norm(), 1, 1e-12);
    for (int i = 0; i < patch.count; ++i) {
        const ContactPoint& point = patch.points[static_cast<size_t>(i)];
        EXPECT_NEAR((point.p_WB - point.p_WA).dot(patch.n_W), point.gap, 1e-9);
        EXPECT_LT(extent(a, X_WA, patch.n_W) - patch.n_W.dot(point.p_WA - X_WA.p), 1e-3);
    }
}

TEST(Round, ShapesAreAsFarApartAsAlongTheBestOfAllDirections) {
    std::mt19937 random(1);
    for (const Round& a : kRounds) {
        for (const Round& b : kRounds) {
            // rims of cylinders have kinks, where the search may not find a better direction
            const double off = a.has_rim() || b.has_rim() ? 3e-4 : 2e-5;
            for (int i = 0; i < 20; ++i) compare(a, b, off, random);
        }
    }
}

TEST(Round, ShapesAreAsFarFromABoxAsAlongTheBestOfAllDirections) {
    std::mt19937 random(2);
    for (const Round& b : kRounds)
        for (int i = 0; i < 60; ++i) compare(kBox, b, 3e-5, random);
}

TEST(Round, LiesOnALineAndStandsOnItsRim) {
    const Round can{0.02, 0.03, Round::Ends::flat};
    const Pose lies{rotation_by(std::numbers::pi / 2 * Vec3::UnitX()), {0, 0, 0.02}};
    ContactPatch patch = collide_half_space({}, can, lies, 5e-4);
    ASSERT_EQ(patch.count, 2);
    EXPECT_NEAR((patch.points[0].p_WB - patch.points[1].p_WB).norm(), 0.06, 1e-12);
    patch = collide_half_space({}, can, {Quat::Identity(), {0, 0, 0.03}}, 5e-4);
    EXPECT_EQ(patch.count, 4);
    for (const ContactPoint& point : patch.points) EXPECT_NEAR(point.gap, 0, 1e-12);
    // a can that lies across an edge of a box touches it at one point; along the edge, at two
    const Pose above{rotation_by(std::numbers::pi / 4 * Vec3::UnitY()), {0, 0, 0}};
    const Quat along = rotation_by(std::numbers::pi / 2 * Vec3::UnitX());
    const Vec3 on_edge = above.R * Vec3(-0.02, 0, 0.015) + 0.02 * Vec3::UnitZ();
    patch = collide(kBox, above, can, {along, on_edge}, 5e-4, Vec3(0, 0, -1));
    EXPECT_EQ(patch.count, 2);
    EXPECT_NEAR(patch.n_W.z(), 1, 1e-6);
    const Quat across = rotation_by(std::numbers::pi / 2 * Vec3::UnitY());
    patch = collide(kBox, above, can, {across, on_edge}, 5e-4, Vec3(0, 0, -1));
    EXPECT_EQ(patch.count, 1);
    EXPECT_NEAR(gap(patch), 0, 1e-9);
}

scene::Body lying(scene::ShapeKind kind, double radius, double length) {
    scene::Body out;
    out.name = "roller";
    out.shape.kind = kind;
    out.shape.radius = radius;
    out.shape.length = length;
    out.rotation = {std::numbers::pi / 2, 0, 0};  // along y
    out.position = {0, 0, radius};
    out.density = 1000;
    out.friction = 0.8;
    return out;
}

TEST(Round, WhatRollsOnALevelGoesOnAsItWas) {
    struct Size {
        double radius, length;
    };
    for (const contact::Solver solver :
         {contact::Solver::newton, contact::Solver::staggered_projections,
          contact::Solver::stewart_trinkle, contact::Solver::sequential_impulse}) {
        for (const Size& size : {Size{0.002, 0.03},
                                 {0.005, 0.15},
                                 {0.01, 0.02},
                                 {0.012, 0.2},
                                 {0.02, 0.004},
                                 {0.02, 0.06},
                                 {0.03, 0.03},
                                 {0.05, 0.01},
                                 {0.04, 0.3},
                                 {0.1, 0.2}}) {
            for (const auto kind : {scene::ShapeKind::cylinder, scene::ShapeKind::capsule}) {
                for (const scene::Body& ground :
                     {plane(scene::Body{}.friction), box("plane", {9, 2, 0.1}, {0, 0, -0.05}, 0)}) {
                    frame::DynamicsSettings settings = awake();
                    settings.solver = solver;
                    World world = make({ground, lying(kind, size.radius, size.length)}, settings);
                    const double speed = 0.2;
                    world.set_motion({1}, {speed, 0, 0}, {0, speed / size.radius, 0});
                    for (int i = 0; i < 1500; ++i) {
                        world.step(kStep);
                        ASSERT_NEAR(world.state({1}).v_WB.x(), speed, 1e-4 * speed)
                            << size.radius << " " << size.length << " " << i;
                    }
                    const Vec3& v = world.state({1}).v_WB;
                    EXPECT_LT(std::abs(v.y()), 1e-4 * speed);
                    EXPECT_NEAR(world.state({1}).X_WB.p.z(), size.radius, 1e-7);
                }
            }
        }
    }
}

TEST(Round, ACanThatIsTiltedFallsBackOrOverByWhereItsCentreIs) {
    // beyond atan(r / half), the can's centre is past its rim
    for (const Vec3& way : {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(0.3, 1, 0)}) {
        const double limit = std::atan(0.02 / 0.03);
        for (const double share : {0.97, 1.03}) {
            scene::Body can = lying(scene::ShapeKind::cylinder, 0.02, 0.06);
            const Quat R = rotation_by(share * limit * way.normalized());
            can.rotation = angles_xyz(R);
            const double low = std::cos(share * limit) * 0.03 + std::sin(share * limit) * 0.02;
            can.position = {0, 0, low};
            World world = make({plane(scene::Body{}.friction), can}, awake());
            for (int i = 0; i < 3000; ++i) world.step(kStep);
            const double upright = (world.state({1}).X_WB.R * Vec3::UnitZ()).z();
            EXPECT_EQ(upright > 0.99, share < 1) << share << " " << upright;
        }
    }
}

TEST(Round, WhatRollsOverSeamsOfFlushBoxesDoesNotFeelThem) {
    std::vector<scene::Body> tiles;
    for (int i = 0; i < 10; ++i)
        tiles.push_back(box("tile" + number_text(i), {0.04, 0.2, 0.02}, {0.04 * i, 0, -0.01}, 0));
    scene::Body ball = block({0, 0, 0.02});
    ball.shape = scene::Shape::sphere(0.02);
    for (const scene::Body& roller :
         {ball, lying(scene::ShapeKind::cylinder, 0.02, 0.05),
          lying(scene::ShapeKind::capsule, 0.02, 0.05), block({0, 0, 0.02}, 0)}) {
        std::vector<scene::Body> bodies = tiles;
        bodies.push_back(roller);
        World world = make(bodies, awake());
        const BodyIndex at{10};
        const double speed = 0.35;
        const bool rolls = roller.shape.kind != scene::ShapeKind::box;
        world.set_motion(at, {speed, 0, 0}, {0, rolls ? speed / 0.02 : 0, 0});
        for (int i = 0; i < 950; ++i) {
            world.step(kStep);
            ASSERT_NEAR(world.state(at).v_WB.x(), speed, 1e-4 * speed) << i;
            ASSERT_NEAR(world.state(at).X_WB.p.z(), 0.02, 1e-6) << i;
        }
    }
}

}  // namespace
}  // namespace dihaptic::dynamics::round_test
