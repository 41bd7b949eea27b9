// Tests a point whose friction is solved with the dynamics: repeats the cases of
// god_object_test.cpp for points on surfaces, and tests mechanics.
#include "haptics/solved_point.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "haptics/finger.h"
#include "haptics/test/shapes.h"
#include "testing/allocation_guard.h"

namespace dihaptic::haptics::solved_point_test {
namespace {

constexpr double kTick = 1e-3;

/// A world, one point in it, and a handle that the test moves.
struct Room {
    scene::Scene scene;
    frame::CouplingSettings coupling;
    frame::ProxySettings proxy;
    frame::DynamicsSettings dynamics;
    std::unique_ptr<World> world;
    std::unique_ptr<Finger> finger;
    BodyIndex point;
    frame::Handle handle;
    int ticks = 0;

    Room() { scene.gravity.setZero(); }
    scene::Body& add(const scene::Shape& shape, const Vec3& position = Vec3::Zero(),
                     const Vec3& rotation = Vec3::Zero()) {
        scene::Body body;
        body.name = "body " + number_text(scene.bodies.size());
        body.shape = shape;
        body.position = position;
        body.rotation = rotation;
        body.fixed = true;
        body.friction = 0;
        return scene.bodies.emplace_back(body);
    }
    bool apart = false;
    void start(const Vec3& p, double friction = 1, double torsion_radius = 0) {
        if (!world) {
            scene::Finger spec;
            spec.name = "index";
            spec.friction = friction;
            spec.torsion_radius = torsion_radius;
            scene.fingers = {spec};
            world = std::make_unique<World>(scene, dynamics);
            point = world->add_point(spec, p);
            world->activate();
            if (apart) {
                finger = std::make_unique<Finger>(PointProxy(scene, point, coupling, proxy), point);
            } else {
                finger =
                    std::make_unique<Finger>(SolvedPoint(scene, point, coupling, proxy), point);
            }
        }
        handle = {p, Vec3::Zero()};
        finger->place(*world, handle);
    }
    /// Does one tick with the handle at p, and returns the force that the handle feels.
    Vec3 follow(const Vec3& p) {
        handle.v_WH = (p - handle.p_WH) / kTick;
        handle.p_WH = p;
        const double step = kTick * dynamics.every;
        finger->begin_tick(*world, handle, step);
        if (ticks++ % dynamics.every == 0) {
            finger->before_step(*world, handle, step);
            world->step(step);
            finger->after_step(*world, handle);
        }
        return finger->force(*world, handle, kTick);
    }
    Vec3 go(const Vec3& to, double stride = 1e-4) {
        const Vec3 from = handle.p_WH;
        const int steps = std::max(1, static_cast<int>((to - from).norm() / stride));
        Vec3 f = Vec3::Zero();
        for (int i = 1; i <= steps; ++i) f = follow(from + (to - from) * i / steps);
        return f;
    }
    /// Waits n ticks until everything is at rest, and returns the force.
    Vec3 wait(int n = 300) {
        Vec3 f = Vec3::Zero();
        for (int i = 0; i < n; ++i) f = follow(handle.p_WH);
        return f;
    }
    const Vec3& position() const { return world->state(point).X_WB.p; }
    double depth() const {
        double deepest = 0;
        for (size_t i = 0; i < scene.bodies.size(); ++i) {
            deepest =
                std::max(deepest, scene::depth(scene.bodies[i].shape,
                                               world->states()[i].X_WB.inverse() * position()));
        }
        return deepest;
    }
};

class EveryShapeSolved : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Surfaces, EveryShapeSolved, ::testing::Range(0, kShapes), shape_name);

/// Like EveryShape in god_object_test.cpp: moves the handle along ten thousand straight paths
/// through a shape, in strides of up to 8 mm.
TEST_P(EveryShapeSolved, PressesAreFeltOutOfTheFaceThatWasEntered) {
    Random random(4, "presses");
    Room room;
    const Vec3 angles(0.3, -0.8, 1.9);
    const Pose X_WB{rotation_xyz(angles), {0.1, -0.2, 0.05}};
    room.add(shape(GetParam()), X_WB.p, angles);
    const scene::Shape& solid = room.scene.bodies[0].shape;
    const Surface surface(solid, kSkin);
    double deepest = -1, furthest_from_foot = 0;
    int pressed = 0, kept = 0, inward = 0, other_face = 0, free_force = 0;
    for (int i = 0; i < 10000; ++i) {
        const auto [from, way, stride] = random_press(random, solid.kind);
        room.start(X_WB * from);
        room.follow(X_WB * from);
        int entered = -1;
        bool left = false;
        for (Vec3 h = from; (h - from).norm() < way.norm(); h += stride) {
            if (const auto entry = surface.enter(h, stride); entry && entered < 0)
                entered = entry->face;
            const Vec3 next = h + stride;
            const Vec3 before = X_WB.inverse() * room.position();
            const Vec3 force_B = X_WB.R.conjugate() * room.follow(X_WB * next);
            const Vec3 p = X_WB.inverse() * room.position();
            deepest = std::max(deepest, room.depth());
            const bool touching = room.finger->touch().touching;
            left = left || (entered >= 0 && !touching && (p - next).norm() < 1e-12);
            if (!touching) {
                free_force += force_B != Vec3::Zero();
                continue;
            }
            ++pressed;
            // the body is convex, so the force leads straight away from it at the point's last
            // position
            inward += surface.separation(before + 1e-3 * force_B.normalized()) < 0.999e-3;
            const Vec3 n = surface.normal(entered, before);
            const Vec3 foot =
                next - surface.distance(entered, next) * surface.normal(entered, next);
            const bool flat = surface.bent_part(entered, foot, Vec3::UnitX()).isZero(0);
            if (!flat || left || surface.separation(foot) > 1e-12) continue;
            ++kept;
            other_face += force_B.normalized().cross(n).norm() > 1e-6 || force_B.dot(n) < 0;
            furthest_from_foot = std::max(furthest_from_foot, (p - foot).norm());
        }
    }
    EXPECT_LT(deepest, kMicron);
    EXPECT_EQ(inward, 0);
    EXPECT_EQ(other_face, 0);
    EXPECT_EQ(free_force, 0);
    EXPECT_LT(furthest_from_foot, 1e-8);
    EXPECT_GT(pressed, 20000);
    if (surface.is_polyhedron()) {
        EXPECT_GT(kept, 10000);
    }
    RecordProperty("deepest_um", number_text(deepest * 1e6));
    RecordProperty("pressed", pressed);
    RecordProperty("kept", kept);
}

TEST(SolvedPoint, NearABoxsCornerTheEnteredFaceIsKept) {
    Room room;
    room.add(scene::Shape::box({0.04, 0.04, 0.04}));
    room.start({0.019, 0, 0.025});
    room.go({0.019, 0, 0.010});
    const double depth = 0.01 + kSkin;
    EXPECT_LT((room.wait() - Vec3(0, 0, 1000 * depth)).norm(), 1e-6);
    EXPECT_LT((room.position() - Vec3(0.019, 0, 0.02 + kSkin)).norm(), 1e-8);
    // beyond the edge the point is free, and on re-entry it touches the side
    room.go({0.022, 0, 0.010});
    EXPECT_EQ(room.wait(), Vec3::Zero());
    room.go({0.012, 0, 0.010});
    EXPECT_LT((room.wait() - Vec3(8 + 1000 * kSkin, 0, 0)).norm(), 1e-6);
}

TEST(SolvedPoint, PushingThroughAThinWedgeIsFeltOutThroughTheFaceItCameBy) {
    Room room;
    room.add(thin_wedge());
    const Vec3 n = Vec3(0.001, 0, 0.03).normalized();  // normal of the upper face
    for (const double stride : {1e-4, 0.028}) {        // slowly, and in a single tick
        room.start({0.015, 0.003, 0.01});
        room.go({0.015, 0.003, -0.008}, stride);
        EXPECT_GT(room.wait().norm(), 8);  // farther than the wedge is thick
        EXPECT_LT(room.wait().normalized().cross(n).norm(), 1e-6);
        EXPECT_GT(room.wait().z(), 0);
        EXPECT_LT(room.depth(), kMicron);
    }
}

TEST(SolvedPoint, ThreeWallsOfARoomsCornerHoldItInTheCorner) {
    Room room;
    room.add(scene::Shape::box({0.2, 0.2, 0.2}), {-0.1, 0.05, 0.05});
    room.add(scene::Shape::box({0.2, 0.2, 0.2}), {0.05, -0.1, 0.05});
    room.add(round(scene::ShapeKind::plane, 0, 0));
    room.start({0.01, 0.02, 0.03});
    room.go({-0.004, -0.003, -0.002});
    EXPECT_LT((room.wait() - Vec3(4, 3, 2) - Vec3::Constant(1000 * kSkin)).norm(), 1e-6);
    EXPECT_LT((room.position() - Vec3::Constant(kSkin)).norm(), 1e-8);
    EXPECT_EQ(room.world->contacts().size(), 3u);
    // moving out along one wall leaves two constraints, then one
    room.go({0.01, -0.003, -0.002});
    EXPECT_LT((room.wait() - Vec3(0, 3, 2) - 1000 * Vec3(0, kSkin, kSkin)).norm(), 1e-6);
    room.go({0.01, 0.01, -0.002});
    EXPECT_LT((room.wait() - Vec3(0, 0, 2 + 1000 * kSkin)).norm(), 1e-6);
}

TEST(SolvedPoint, ATurntableCarriesItAround) {
    // the point sticks to a disc that turns freely and, pulled along a circle, turns the disc
    Room room;
    scene::Body& disc = room.add(round(scene::ShapeKind::cylinder, 0.05, 0.02), {0, 0, -0.01});
    disc.fixed = false;
    disc.mass = 0.1;
    disc.friction = 1;
    disc.moves = scene::Axes::none;
    disc.turns = scene::Axes::z;
    room.start({0.03, 0, 0.001});
    room.go({0.03, 0, -0.003});
    const Vec3 start = room.world->state({0}).X_WB.inverse() * room.position();
    for (int i = 1; i <= 4000; ++i)
        room.follow(rotation_xyz({0, 0, 2e-3 * i}) * Vec3(0.03, 0, -0.003));
    const Pose X_WB = room.world->state({0}).X_WB;
    EXPECT_LT((X_WB.inverse() * room.position() - start).norm(), 1e-6);
    EXPECT_NEAR(angle_between(X_WB.R, rotation_xyz({0, 0, 8.0})), 0, 0.02);
}

TEST(SolvedPoint, AFallingPlateIsCaughtAndItsWeightFelt) {
    // a plate of 200 g that can only move vertically falls on a point that waits
    Room room;
    room.scene.gravity = {0, 0, -9.81};
    scene::Body& plate = room.add(scene::Shape::box({0.05, 0.05, 0.002}), {0, 0, 0.02});
    plate.fixed = false;
    plate.mass = 0.2;
    plate.friction = 1;
    plate.moves = scene::Axes::z;
    plate.turns = scene::Axes::none;
    room.coupling.damping = 10;
    room.start({0.01, 0, 0});
    double deepest = 0;
    for (int i = 0; i < 3000; ++i) {
        room.wait(1);
        deepest = std::max(deepest, room.depth());
    }
    EXPECT_LT(deepest, kMicron);
    EXPECT_NEAR(-room.wait().z() / (0.2 * 9.81), 1, 1e-3);
}

TEST(SolvedPoint, SticksUnderStaticFrictionAndSlidesAtDynamicFriction) {
    // at a depth of 2 mm, static friction of 0.8 holds 1.6 N, and dynamic friction, half as large,
    // 0.8 N
    Room room;
    room.add(round(scene::ShapeKind::plane, 0, 0)).friction = 0.64;  // 0.8 for the pair
    room.proxy.sliding_friction = 0.5;
    room.start({0, 0, 0.001});
    room.go({0, 0, -0.002 + kSkin});
    room.go({0.0015, 0, -0.002 + kSkin});
    EXPECT_LT((room.wait() - Vec3(-1.5, 0, 2)).norm(), 1e-4);
    EXPECT_LT(room.position().head<2>().norm(), 1e-7);
    const Vec3 f = room.go({0.02, 0, -0.002 + kSkin});
    EXPECT_NEAR(f.x() / f.z(), -0.4, 1e-6);
    // the point comes to rest and sticks again, up to the limit of static friction
    room.wait();
    const double rest = room.position().x();
    room.go({rest + 0.00155, 0, -0.002 + kSkin}, 1e-5);
    EXPECT_NEAR(room.wait().x(), -1.55, 1e-3);
}

TEST(SolvedPoint, BetweenStepsOfTheWorldTheForceIsThatOfTheHandle) {
    // the world steps every 10 ticks; the handle meets a wall between two steps
    Room room;
    room.dynamics.every = 10;
    room.coupling.damping = 0;
    room.add(round(scene::ShapeKind::plane, 0, 0)).friction = 1;
    room.start({0, 0, 0.0101});
    const Vec3 stride(0, 0, -2e-4);
    for (int i = 1; i <= 100; ++i) {
        const Vec3 h = Vec3(0, 0, 0.0101) + i * stride;
        const double f = room.follow(h).z();
        EXPECT_NEAR(f, std::max(0.0, 1000 * (kSkin - h.z())), 1e-6) << i;
    }
    // while the point sticks, the tangential force of the spring is within the cone in every tick
    for (int i = 0; i < 100; ++i) {
        const Vec3 f = room.follow(room.handle.p_WH + Vec3(2e-4, 0, 0));
        EXPECT_LE(f.head<2>().norm(), f.z() * (1 + 1e-9)) << i;
        EXPECT_GT(f.z(), 9);
    }
}

TEST(SolvedPoint, ASurfaceThatIsPressedTooHardYieldsUntilThePointHasLeftIt) {
    for (const bool apart : {false, true}) {
        SCOPED_TRACE(apart);
        Room room;
        room.apart = apart;
        room.proxy.popthrough = 4;
        room.add(scene::Shape::box({0.04, 0.04, 0.03}), {0, 0, -0.015});
        room.add(round(scene::ShapeKind::plane, 0, 0), {0, 0, -0.04});
        room.start({0, 0, 0.001});
        room.go({0, 0, -0.0038}, 1e-5);
        EXPECT_NEAR(room.wait().z(), 3.8 + 1000 * kSkin, 1e-3);
        room.go({0, 0, -0.02}, 1e-5);
        EXPECT_EQ(room.wait(), Vec3::Zero());
        EXPECT_LT((room.position() - Vec3(0, 0, -0.02)).norm(), 1e-9);
        // bodies beyond the box are felt, and so is the box once the point has left it
        room.go({0, 0, -0.041}, 1e-5);
        EXPECT_NEAR(room.wait().z(), 1 + 1000 * kSkin, 1e-3);
        room.go({0.03, 0, -0.035}, 1e-5);
        room.go({0.03, 0, -0.01}, 1e-5);
        room.go({0.018, 0, -0.01}, 1e-5);
        EXPECT_NEAR(room.wait().x(), 2 + 1000 * kSkin, 1e-3);
    }
}

TEST(SolvedPoint, AllocatesNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Room room;
    for (int i = 0; i < kShapes; ++i) room.add(shape(i));
    room.start({0, 0, 0.1}, 0.4, 0.005);
    const testing::AllocationGuard guard;
    room.go({0.02, 0.01, -0.05});
    EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace dihaptic::haptics::solved_point_test
