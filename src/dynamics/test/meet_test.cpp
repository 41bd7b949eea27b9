// Tests that overlapping bodies, however deep, have a contact as deep as their overlap.
#include "dynamics/bullet/shape.h"
#include "dynamics/test/shots.h"

namespace dihaptic::dynamics::meet_test {
namespace {

ContactPatch meet(const CollisionPart& a, const Pose& X_WA, const CollisionPart& b,
                  const Pose& X_WB) {
    constexpr double kMargin = 1e-3;  // [m]
    const Vec3 way = Vec3::Zero();
    if (a.polyhedron && b.polyhedron)
        return collide(*a.polyhedron, X_WA, *b.polyhedron, X_WB, kMargin, way);
    if (a.polyhedron) return collide(*a.polyhedron, X_WA, *b.round, X_WB, kMargin, way);
    if (b.polyhedron) return collide(*b.polyhedron, X_WB, *a.round, X_WA, kMargin, way);
    return collide(*a.round, X_WA, *b.round, X_WB, kMargin);
}

TEST(Meet, WhatOverlapsHasAContactThatIsAsDeep) {
    constexpr double kDeep = 2e-4;  // [m]
    int overlap = 0;
    for (uint64_t seed = 0; seed < 5000; ++seed) {
        Random random(seed, "pair");
        const scene::Body a = any_body("a", random);
        const scene::Body b = any_body("b", random);
        const std::vector<Vec3> of_a = points_of(a.shape, random);
        const std::vector<Vec3> of_b = points_of(b.shape, random);
        const Pose X_WA{rotation_xyz(a.rotation), Vec3::Zero()};
        const Pose X_WB{rotation_xyz(b.rotation), 0.02 * any_direction(random)};
        const double deep = overlap_of(a, X_WA, of_a, b, X_WB, of_b);
        if (deep < kDeep) continue;
        ++overlap;
        const ContactPatch patch =
            meet(*collision_parts(a.shape, {})[0], X_WA, *collision_parts(b.shape, {})[0], X_WB);
        double gap = 0;
        for (int i = 0; i < patch.count; ++i)
            gap = std::min(gap, patch.points[static_cast<size_t>(i)].gap);
        EXPECT_LT(gap, 1e-6 - deep)
            << seed << ": " << enum_name(a.shape.kind) << " and " << enum_name(b.shape.kind);
    }
    EXPECT_GT(overlap, 1000);
}

}  // namespace
}  // namespace dihaptic::dynamics::meet_test
