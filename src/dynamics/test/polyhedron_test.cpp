#include "dynamics/polyhedron.h"

#include <gtest/gtest.h>

#include <numbers>

#include "base/random.h"
#include "testing/allocation_guard.h"

namespace dihaptic::dynamics::polyhedron_test {
namespace {

const Polyhedron kCube = Polyhedron::box({0.04, 0.04, 0.04});
const Polyhedron kPad = Polyhedron::box({0.005, 0.02, 0.02});

TEST(Polyhedron, OfABoxHasItsFacesAndEdges) {
    EXPECT_EQ(kCube.faces.size(), 6u);
    EXPECT_EQ(kCube.edges.size(), 12u);
    EXPECT_EQ(kCube.directions.size(), 3u);
    for (const Polyhedron::Face& face : kCube.faces) {
        EXPECT_NEAR(face.offset, 0.02, 1e-15);
        for (const Vec3& v : kCube.vertices) EXPECT_LE(face.normal.dot(v), face.offset + 1e-15);
    }
}

TEST(Collide, FaceOnFaceGivesTheFourCornersOfTheSharedPatch) {
    const double gap = 2e-4;
    const ContactPatch patch =
        collide(kCube, {}, kPad, {Quat::Identity(), {0.0225 + gap, 0.003, -0.002}}, 5e-4);
    ASSERT_EQ(patch.count, 4);
    EXPECT_LT((patch.n_W - Vec3::UnitX()).norm(), 1e-15);
    for (int i = 0; i < 4; ++i) {
        const ContactPoint& p = patch.points[static_cast<size_t>(i)];
        EXPECT_NEAR(p.gap, gap, 1e-15);
        EXPECT_NEAR(p.p_WA.x(), 0.02, 1e-15);
        EXPECT_NEAR(p.p_WB.x(), 0.02 + gap, 1e-15);
        EXPECT_NEAR(std::abs(p.p_WA.y() - 0.003), 0.01, 1e-15);
        EXPECT_NEAR(std::abs(p.p_WA.z() + 0.002), 0.01, 1e-15);
    }
}

TEST(Collide, BeyondTheMarginGivesNothing) {
    EXPECT_EQ(collide(kCube, {}, kPad, {Quat::Identity(), {0.0225 + 6e-4, 0, 0}}, 5e-4).count, 0);
}

TEST(Collide, ACornerPointingDownTouchesWithItsVertex) {
    const double diagonal = 0.02 * std::numbers::sqrt3;
    const Quat R = Quat::FromTwoVectors(Vec3(1, 1, 1).normalized(), -Vec3::UnitZ());
    const ContactPatch patch =
        collide(Polyhedron::box({1, 1, 0.1}), {Quat::Identity(), {0, 0, -0.05}}, kCube,
                {R, {0, 0, diagonal - 1e-5}}, 5e-4);
    ASSERT_EQ(patch.count, 1);
    EXPECT_NEAR(patch.points[0].gap, -1e-5, 1e-15);
    EXPECT_LT((patch.n_W - Vec3::UnitZ()).norm(), 1e-14);
    EXPECT_LT(patch.points[0].p_WB.head<2>().norm(), 1e-14);
}

TEST(Collide, CrossedEdgesTouchInOnePoint) {
    // two cubes that stand on an edge, one above the other, their edges crossed at right angles
    const double eighth = std::numbers::pi / 4;
    const double half_diagonal = 0.02 * std::numbers::sqrt2;
    const Pose lower{rotation_xyz({eighth, 0, 0}), {0, 0, 0}};
    const Pose upper{rotation_xyz({0, eighth, 0}), {0.003, -0.004, 2 * half_diagonal - 1e-4}};
    const ContactPatch patch = collide(kCube, lower, kCube, upper, 5e-4);
    ASSERT_EQ(patch.count, 1);
    EXPECT_NEAR(patch.points[0].gap, -1e-4, 1e-14);
    EXPECT_LT((patch.n_W - Vec3::UnitZ()).norm(), 1e-14);
    EXPECT_LT((patch.points[0].p_WA - Vec3(0.003, 0, half_diagonal)).norm(), 1e-14);
}

TEST(Collide, IsTheSameSeenFromTheOtherSide) {
    Random random(3, "poses");
    int touching = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto angle = [&] { return random.uniform(-3, 3); };
        const auto place = [&] { return random.uniform(-0.03, 0.03); };
        const Pose X_WA{rotation_xyz({angle(), angle(), angle()}), {place(), place(), place()}};
        const Pose X_WB{rotation_xyz({angle(), angle(), angle()}),
                        {place(), place(), place() + 0.03}};
        const ContactPatch ab = collide(kCube, X_WA, kPad, X_WB, 1e-3);
        const ContactPatch ba = collide(kPad, X_WB, kCube, X_WA, 1e-3);
        ASSERT_EQ(ab.count > 0, ba.count > 0);
        if (ab.count == 0) continue;
        ++touching;
        double deepest_ab = 1, deepest_ba = 1;
        for (int k = 0; k < ab.count; ++k)
            deepest_ab = std::min(deepest_ab, ab.points[static_cast<size_t>(k)].gap);
        for (int k = 0; k < ba.count; ++k)
            deepest_ba = std::min(deepest_ba, ba.points[static_cast<size_t>(k)].gap);
        EXPECT_NEAR(deepest_ab, deepest_ba, 2e-5);
    }
    EXPECT_GT(touching, 200);
}

TEST(Collide, TurnsAndMovesWithTheWorld) {
    Random random(4, "world");
    const Pose X_AB{rotation_xyz({0.2, 0.1, 0.3}), {0.021, 0.005, 0.002}};
    const ContactPatch here = collide(kCube, {}, kPad, X_AB, 1e-3);
    ASSERT_GT(here.count, 0);
    for (int i = 0; i < 20; ++i) {
        const auto any = [&] { return random.uniform(-2, 2); };
        const Pose X_WA{rotation_xyz({any(), any(), any()}), {any(), any(), any()}};
        const ContactPatch there = collide(kCube, X_WA, kPad, X_WA * X_AB, 1e-3);
        ASSERT_EQ(here.count, there.count);
        EXPECT_LT((X_WA.R * here.n_W - there.n_W).norm(), 1e-12);
        for (int k = 0; k < here.count; ++k) {
            EXPECT_LT((X_WA * here.points[static_cast<size_t>(k)].p_WA -
                       there.points[static_cast<size_t>(k)].p_WA)
                          .norm(),
                      1e-12);
        }
    }
}

TEST(CollideHalfSpace, GivesTheCornersThatAreNear) {
    const Pose plane{rotation_xyz({0, 0.3, 0}), {0, 0, 0.1}};
    const ContactPatch patch =
        collide_half_space(plane, kCube, {plane.R, plane * Vec3(0.1, 0.2, 0.02 - 1e-6)}, 5e-4);
    ASSERT_EQ(patch.count, 4);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(patch.points[static_cast<size_t>(i)].gap, -1e-6, 1e-14);
    EXPECT_LT((patch.n_W - plane.R * Vec3::UnitZ()).norm(), 1e-15);
}

TEST(Collide, AllocatesNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    const testing::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
        collide(kCube, {}, kPad, {rotation_xyz({0.01 * i, 0.02 * i, 0}), {0.022, 0, 0}}, 1e-3);
        collide_half_space({}, kCube, {rotation_xyz({0.01 * i, 0, 0}), {0, 0, 0.02}}, 1e-3);
    }
    EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace dihaptic::dynamics::polyhedron_test
