// Tests the position of the point proxy against geometry and Coulomb's law, with presses on every
// shape, corners, wedges and moving bodies.
#include <gtest/gtest.h>

#include <numbers>

#include "base/number.h"
#include "base/random.h"
#include "haptics/god_object.h"
#include "haptics/test/shapes.h"
#include "testing/allocation_guard.h"

namespace dihaptic::haptics::god_object_test {
namespace {

/// Bodies that are fixed or moved by the test, and one point among them.
struct Room {
    std::vector<scene::Body> bodies;
    std::vector<dynamics::BodyState> states;
    std::unique_ptr<GodObject> point;

    void add(const scene::Shape& shape, const Pose& X_WB = {}) {
        scene::Body body;
        body.shape = shape;
        bodies.push_back(body);
        states.emplace_back();
        states.back().X_WB = X_WB;
    }
    double skin = 0;  // makes closed forms exact

    void start(const Vec3& p, double friction = 0, double sliding = 1) {
        point = std::make_unique<GodObject>(bodies, std::vector<double>(bodies.size(), friction),
                                            sliding, skin);
        point->place(p, states);
    }
    const Vec3& follow(const Vec3& p_WH) {
        point->follow(p_WH, states);
        return point->position();
    }
    /// Moves the handle straight to the target, in steps of 0.1 mm.
    void go(const Vec3& from, const Vec3& to) {
        const int steps = std::max(1, static_cast<int>((to - from).norm() / 1e-4));
        for (int i = 1; i <= steps; ++i) follow(from + (to - from) * i / steps);
    }
    /// Depth of the point in any body [m].
    double depth() const {
        double deepest = 0;
        for (size_t i = 0; i < bodies.size(); ++i) {
            deepest = std::max(deepest, scene::depth(bodies[i].shape,
                                                     states[i].X_WB.inverse() * point->position()));
        }
        return deepest;
    }
};

class EveryShape : public ::testing::TestWithParam<int> {};

/// Moves the handle along ten thousand straight paths from the outside through a shape, in strides
/// of up to 8 mm. The point must stay outside, and the force that holds it back must point out of
/// the shape. While the projection of the handle onto the face of entry is within that face, the
/// point must be there, however thin the shape.
TEST_P(EveryShape, PressesAreFeltOutOfTheFaceThatWasEntered) {
    Random random(4, "presses");
    Room room;
    room.skin = kSkin;
    const Pose X_WB{rotation_xyz({0.3, -0.8, 1.9}), {0.1, -0.2, 0.05}};
    room.add(shape(GetParam()), X_WB);
    const Surface surface(room.bodies[0].shape, kSkin);
    double deepest = -1, worst_angle = 0, furthest_from_foot = 0;
    int pressed = 0, kept = 0;
    for (int i = 0; i < 10000; ++i) {
        const auto [from, way, stride] = random_press(random, room.bodies[0].shape.kind);
        room.start(X_WB * from);
        int entered = -1;
        bool left = false;
        for (Vec3 h = from; (h - from).norm() < way.norm(); h += stride) {
            if (const auto entry = surface.enter(h, stride); entry && entered < 0)
                entered = entry->face;
            const Vec3 next = h + stride;
            const Vec3 p = room.follow(X_WB * next);
            deepest = std::max(deepest, room.depth());
            const auto contacts = room.point->contacts();
            left = left || (entered >= 0 && contacts.empty());
            if (contacts.empty()) {
                EXPECT_LT((p - X_WB * next).norm(), 1e-9);
                continue;
            }
            ++pressed;
            const Vec3 force = p - X_WB * next;
            EXPECT_GT(force.dot(contacts[0].n_W), 0);
            const Vec3 foot =
                next - surface.distance(entered, next) * surface.normal(entered, next);
            const bool flat = surface.bent_part(entered, foot, Vec3::UnitX()).isZero(0);
            // if the handle is near its centre, a round shape lets the point slip round to the
            // other side within a few ticks
            const bool shallow =
                flat || surface.distance(entered, next) > -0.6 * surface.bend_radius(foot);
            if (shallow && force.norm() > 1e-6) {
                worst_angle =
                    std::max(worst_angle, force.normalized().cross(contacts[0].n_W).norm());
            }
            if (!flat || left || surface.separation(foot) > 1e-12) continue;
            ++kept;
            EXPECT_EQ(contacts[0].face, entered);
            furthest_from_foot = std::max(furthest_from_foot, (p - X_WB * foot).norm());
        }
    }
    EXPECT_LT(deepest, kMicron);
    EXPECT_LT(worst_angle, 1e-3);
    EXPECT_LT(furthest_from_foot, 1e-9);
    EXPECT_GT(pressed, 20000);
    if (surface.is_polyhedron()) {
        EXPECT_GT(kept, 10000);
    }
    RecordProperty("deepest_um", number_text(deepest * 1e6));
    RecordProperty("worst_angle", number_text(worst_angle));
    RecordProperty("pressed", pressed);
    RecordProperty("kept", kept);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, EveryShape, ::testing::Range(0, kShapes), shape_name);

TEST(GodObject, FollowsTheHandleExactlyInFreeSpace) {
    Room room;
    room.add(scene::Shape::sphere(0.01));
    room.start({0.1, 0, 0});
    EXPECT_EQ(room.follow({0.1, 0.2, -0.3}), Vec3(0.1, 0.2, -0.3));
    EXPECT_TRUE(room.point->contacts().empty());
}

TEST(GodObject, NearABoxsCornerTheEnteredFaceIsKept) {
    // the handle is 1 mm from the edge; at a depth of 5 mm the side is nearer, but the point
    // entered through the top
    Room room;
    room.add(scene::Shape::box({0.04, 0.04, 0.04}));
    room.start({0.019, 0, 0.025});
    room.go({0.019, 0, 0.025}, {0.019, 0, 0.010});
    EXPECT_LT((room.point->position() - Vec3(0.019, 0, 0.02)).norm(), 1e-9);
    EXPECT_LT((room.point->contacts()[0].n_W - Vec3::UnitZ()).norm(), 1e-12);
    // beyond the edge the point is free, and on re-entry it touches the side
    room.go({0.019, 0, 0.010}, {0.022, 0, 0.010});
    EXPECT_TRUE(room.point->contacts().empty());
    room.go({0.022, 0, 0.010}, {0.012, 0, 0.010});
    EXPECT_LT((room.point->position() - Vec3(0.02, 0, 0.010)).norm(), 1e-9);
    EXPECT_LT((room.point->contacts()[0].n_W - Vec3::UnitX()).norm(), 1e-12);
}

TEST(GodObject, PushingThroughAThinWedgeIsFeltOutThroughTheFaceItCameBy) {
    Room room;
    room.add(thin_wedge());
    const Vec3 n = Vec3(0.001, 0, 0.03).normalized();  // normal of the upper face
    const Vec3 above(0.015, 0.003, 0.01);
    room.start(above);
    room.go(above, {0.015, 0.003, -0.008});
    const Vec3 force = room.point->position() - Vec3(0.015, 0.003, -0.008);
    EXPECT_LT((force.normalized() - n).norm(), 1e-6);
    EXPECT_GT(force.norm(), 0.008);  // farther than the wedge is thick
    EXPECT_LT(room.depth(), kOnSurface);
    // a stroke right through the wedge in a single tick
    room.start(above);
    room.follow({0.015, 0.003, -0.02});
    EXPECT_LT((room.point->position() - Vec3(0.015, 0.003, -0.02)).normalized().cross(n).norm(),
              1e-6);
    EXPECT_GT(room.point->position().z(), 0);
}

TEST(GodObject, ThreeWallsOfARoomsCornerHoldItInTheCorner) {
    // the walls fill x < 0, y < 0 and z < 0
    Room room;
    room.add(scene::Shape::box({0.2, 0.2, 0.2}), {Quat::Identity(), {-0.1, 0.05, 0.05}});
    room.add(scene::Shape::box({0.2, 0.2, 0.2}), {Quat::Identity(), {0.05, -0.1, 0.05}});
    room.add(round(scene::ShapeKind::plane, 0, 0));
    room.start({0.01, 0.02, 0.03});
    room.go({0.01, 0.02, 0.03}, {-0.004, -0.003, -0.002});
    EXPECT_LT(room.point->position().norm(), 1e-9);
    ASSERT_EQ(room.point->contacts().size(), 3u);
    Vec3 sum = Vec3::Zero();
    for (const PointContact& c : room.point->contacts()) sum += c.depth * c.n_W;
    EXPECT_LT((sum - Vec3(0.004, 0.003, 0.002)).norm(), 1e-9);
    // moving out along one wall leaves two constraints, then one
    room.go({-0.004, -0.003, -0.002}, {0.01, -0.003, -0.002});
    EXPECT_LT((room.point->position() - Vec3(0.01, 0, 0)).norm(), 1e-9);
    EXPECT_EQ(room.point->contacts().size(), 2u);
    room.go({0.01, -0.003, -0.002}, {0.01, 0.01, -0.002});
    EXPECT_LT((room.point->position() - Vec3(0.01, 0.01, 0)).norm(), 1e-9);
    EXPECT_EQ(room.point->contacts().size(), 1u);
}

TEST(GodObject, ANotchBetweenTiltedWallsIsExact) {
    // two half-spaces that meet at an angle of 60 degrees along y: the forces are those of a wedge
    Room room;
    const double third = std::numbers::pi / 3;
    room.add(round(scene::ShapeKind::plane, 0, 0), {rotation_xyz({0, third, 0}), Vec3::Zero()});
    room.add(round(scene::ShapeKind::plane, 0, 0), {rotation_xyz({0, -third, 0}), Vec3::Zero()});
    room.start({0, 0, 0.02});
    room.go({0, 0, 0.02}, {0.0005, 0.006, -0.01});
    EXPECT_LT((room.point->position() - Vec3(0, 0.006, 0)).norm(), 1e-9);
    ASSERT_EQ(room.point->contacts().size(), 2u);
    Vec3 sum = Vec3::Zero();
    for (const PointContact& c : room.point->contacts()) sum += c.depth * c.n_W;
    EXPECT_LT((sum - Vec3(-0.0005, 0, 0.01)).norm(), 1e-9);
}

TEST(GodObject, AMovingBodyPushesIt) {
    // a box moves in from the left at 0.5 m/s while the handle stands still
    Room room;
    room.add(scene::Shape::box({0.02, 0.04, 0.04}), {Quat::Identity(), {-0.03, 0, 0}});
    room.start({0, 0.005, 0});
    for (int i = 0; i < 100; ++i) {
        room.states[0].X_WB.p.x() += 0.5e-3;
        room.follow({0, 0.005, 0});
        EXPECT_LT(room.depth(), 2 * kOnSurface);
        const double face = room.states[0].X_WB.p.x() + 0.01;
        EXPECT_NEAR(room.point->position().x(), std::max(0.0, face), 1e-9);
    }
    EXPECT_NEAR(room.point->position().y(), 0.005, 1e-9);
}

TEST(GodObject, AFastThinBodyDoesNotPassThroughIt) {
    // a plate 1 mm thick moves by 20 mm in a tick
    Room room;
    room.add(scene::Shape::box({0.001, 0.04, 0.04}), {Quat::Identity(), {-0.01, 0, 0}});
    room.start({0, 0.005, 0});
    room.states[0].X_WB.p.x() = 0.01;
    room.follow({0, 0.005, 0});
    EXPECT_NEAR(room.point->position().x(), 0.0105, 1e-9);
    EXPECT_GT(room.point->contacts()[0].n_W.x(), 0.999);
}

TEST(GodObject, ATurningBodyCarriesItAtFullFriction) {
    // the point sticks to a turntable and turns exactly with it, while the handle turns with both
    Room room;
    room.add(round(scene::ShapeKind::cylinder, 0.05, 0.02), {Quat::Identity(), {0, 0, -0.01}});
    room.start({0.03, 0, 0.001}, 2.0);
    room.follow({0.03, 0, -0.003});
    for (int i = 1; i <= 2000; ++i) {
        const Quat R = rotation_xyz({0, 0, i * 1e-3});
        room.states[0].X_WB.R = R;
        // the handle lags by 4 mm, which is within the cone of 2 x 3 mm
        room.follow(R * Vec3(0.03, -0.004, -0.003));
    }
    const Quat R = rotation_xyz({0, 0, 2.0});
    EXPECT_LT((room.point->position() - R * Vec3(0.03, 0, 0)).norm(), 1e-7);
    EXPECT_FALSE(room.point->sliding());
}

TEST(GodObject, TwoBodiesThatMoveTogetherCarryIt) {
    // the point is in the corner between a box and a plate that fly off together while turning
    Room room;
    room.skin = kSkin;
    room.add(scene::Shape::box({0.1, 0.1, 0.02}), {Quat::Identity(), {0, 0, -0.01}});
    room.add(scene::Shape::box({0.02, 0.1, 0.1}), {Quat::Identity(), {-0.01, 0, 0.05}});
    const std::vector<dynamics::BodyState> first = room.states;
    room.start({0.002, 0, 0.002}, 0.5);
    room.follow({-0.003, 0.0005, -0.004});
    EXPECT_EQ(room.point->contacts().size(), 2u);
    const Vec3 p = room.point->position();
    for (int i = 1; i <= 1000; ++i) {
        const Pose X{rotation_xyz({1e-3 * i, 0, 0.5e-3 * i}), {0.2e-3 * i, 0, 0.1e-3 * i}};
        for (size_t b = 0; b < 2; ++b) room.states[b].X_WB = X * first[b].X_WB;
        room.follow(X * Vec3(-0.003, 0.0005, -0.004));
        EXPECT_LT(room.depth(), kMicron);
        EXPECT_LT((room.point->position() - X * p).norm(), kMicron);
    }
}

TEST(GodObject, DoesNotSlipUnderABlockThatStandsOnATable) {
    // 1 um above the table, as solvers leave it
    Room room;
    room.skin = kSkin;
    room.add(round(scene::ShapeKind::plane, 0, 0));
    room.add(scene::Shape::box({0.04, 0.04, 0.04}), {Quat::Identity(), {0, 0, 0.020001}});
    room.start({0.03, 0, 0.001});
    room.go({0.03, 0, 0.001}, {0.03, 0, -0.003});
    room.go({0.03, 0, -0.003}, {0.01, 0.002, -0.003});
    EXPECT_LT((room.point->position() - Vec3(0.02 + kSkin, 0.002, kSkin)).norm(), 1e-9);
    EXPECT_EQ(room.point->contacts().size(), 2u);
}

TEST(GodObject, SticksUnderStaticFrictionAndSlidesAtDynamicFriction) {
    // 2 mm deep: static friction of 0.8 holds 1.6 mm, dynamic friction of half as much holds 0.8 mm
    Room room;
    room.add(round(scene::ShapeKind::plane, 0, 0));
    room.start({0, 0, 0.001}, 0.8, 0.5);
    room.go({0, 0, 0.001}, {0, 0, -0.002});
    room.go({0, 0, -0.002}, {0.0015, 0, -0.002});
    EXPECT_LT(room.point->position().norm(), 1e-9);
    room.follow({0.00159, 0, -0.002});
    EXPECT_LT(room.point->position().norm(), 1e-9);
    EXPECT_FALSE(room.point->sliding());
    room.follow({0.00161, 0, -0.002});
    EXPECT_TRUE(room.point->sliding());
    EXPECT_NEAR(room.point->position().x(), 0.00161 - 0.0008, 1e-9);
    // the point keeps sliding behind the handle, and rests when the handle stops
    room.go({0.00161, 0, -0.002}, {0.01, 0, -0.002});
    EXPECT_NEAR(room.point->position().x(), 0.01 - 0.0008, 1e-9);
    EXPECT_NEAR(room.point->held().norm(), 0.0008, 1e-9);
    room.follow({0.01, 0, -0.002});
    EXPECT_FALSE(room.point->sliding());
    // the point then sticks again, up to the limit of static friction
    room.follow({0.01075, 0, -0.002});
    EXPECT_NEAR(room.point->position().x(), 0.0092, 1e-9);
    room.follow({0.01085, 0, -0.002});
    EXPECT_TRUE(room.point->sliding());
}

TEST(GodObject, WithoutFrictionItKeepsToTheFoot) {
    Room room;
    room.add(round(scene::ShapeKind::plane, 0, 0));
    room.start({0, 0, 0.001});
    room.go({0, 0, 0.001}, {0, 0, -0.004});
    room.go({0, 0, -0.004}, {0.02, 0.01, -0.004});
    EXPECT_LT((room.point->position() - Vec3(0.02, 0.01, 0)).norm(), 1e-9);
    EXPECT_EQ(room.point->held().norm(), 0);
}

TEST(GodObject, OnASphereItIsNearestToTheHandle) {
    Room room;
    room.add(scene::Shape::sphere(0.015));
    room.start({0, 0, 0.02});
    room.go({0, 0, 0.02}, {0, 0, 0.010});
    // move around the sphere, 5 mm deep and 12 mm deep
    for (const double radius : {0.010, 0.003}) {
        double worst = 0;
        for (int i = 0; i < 3000; ++i) {
            const double a = 1e-3 * i;
            const Vec3 h = radius * Vec3(std::sin(a), 0, std::cos(a));
            worst = std::max(worst, (room.follow(h) - 0.015 * h.normalized()).norm());
        }
        EXPECT_LT(worst, kMicron) << radius;
        room.go(room.point->position(), {0, 0, 0.02});
        room.go({0, 0, 0.02}, {0, 0, 0.003});
    }
}

TEST(GodObject, WhatItStartsInsideOfIsFeltOnceItHasLeft) {
    Room room;
    room.add(scene::Shape::box({0.02, 0.02, 0.02}));
    room.start(Vec3::Zero());
    EXPECT_EQ(room.follow({0, 0, 0.005}), Vec3(0, 0, 0.005));
    room.follow({0, 0, 0.012});
    room.follow({0, 0, 0.005});
    EXPECT_NEAR(room.point->position().z(), 0.01, 1e-9);
}

TEST(GodObject, RandomRoomsAreNeverEntered) {
    // bodies of every kind drift and turn close to each other without touching
    Random random(12, "test");
    for (int trial = 0; trial < 40; ++trial) {
        Room room;
        room.skin = kSkin;
        for (int i = 0; i < kShapes; ++i) {
            const double a = 2 * std::numbers::pi * i / kShapes;
            const bool endless = shape(i).kind == scene::ShapeKind::plane;
            room.add(shape(endless ? 0 : i), {rotation_xyz(random_vector(random)),
                                              0.12 * Vec3(std::cos(a), std::sin(a), 0)});
        }
        room.start(Vec3::Zero(), trial % 2 ? 0.5 : 0.0);
        Vec3 h = Vec3::Zero();
        Vec3 v = Vec3::Zero();
        std::vector<Vec3> turn(kShapes);
        for (Vec3& w : turn) w = random_vector(random);
        double deepest = 0;
        for (int i = 0; i < 2000; ++i) {
            v += 0.05 * random_vector(random) - 0.02 * v;
            h += 1e-3 * v;
            if (h.norm() > 0.2) v = -h;
            for (size_t b = 0; b < turn.size(); ++b) {
                Pose& X = room.states[b].X_WB;
                X.R = (rotation_xyz(1e-3 * turn[b]) * X.R).normalized();
            }
            room.follow(h);
            deepest = std::max(deepest, room.depth());
        }
        EXPECT_LT(deepest, kMicron) << trial;
    }
}

TEST(GodObject, AllocatesNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Room room;
    for (int i = 0; i < kShapes; ++i) room.add(shape(i));
    room.start({0, 0, 0.1}, 0.4, 0.7);
    const testing::AllocationGuard guard;
    room.go({0, 0, 0.1}, {0.02, 0.01, -0.05});
    EXPECT_EQ(guard.count(), 0u);
}

/// Two boxes of 40 x 40 x 20 mm side by side along x, with their tops at z = 0, turned by `angle`
/// about z. The top of the second box is off by `step`, as rounding errors leave it.
scene::Shape two_boards(double angle, double step) {
    scene::Shape shape;
    shape.kind = scene::ShapeKind::compound;
    for (const double side : {-1.0, 1.0}) {
        scene::Part part;
        part.shape = scene::Shape::box({0.04, 0.04, 0.02});
        part.rotation.z() = angle;
        part.position = rotation_xyz(part.rotation) * Vec3(side * 0.02, 0, -0.01);
        if (side > 0) part.position.z() += step;
        shape.parts.push_back(part);
    }
    return shape;
}

TEST(GodObject, SlidesOverTheSeamBetweenTwoParts) {
    for (const double angle : {0.0, 0.3, 1.0, 2.5}) {
        for (const double step : {0.0, 4e-9, -4e-9, 5e-8}) {
            {
                Room room;
                room.skin = kSkin;  // otherwise the point would fall into the seam
                room.add(two_boards(angle, step), {rotation_xyz({0.2, 0.1, 0}), {0.1, 0.2, 0.3}});
                const auto at = [&](double x, double z) {
                    return Vec3(room.states[0].X_WB *
                                (rotation_xyz({0, 0, angle}) * Vec3(x, 0.003, z)));
                };
                room.start(at(-0.03, 0.01));
                room.go(at(-0.03, 0.01), at(-0.03, -0.004));
                for (const double end : {0.03, -0.03, 0.03}) {
                    room.go(at(-end, -0.004), at(end, -0.004));
                    EXPECT_LT((room.point->position() - at(end, kSkin)).norm(), 1e-6)
                        << angle << " " << step;
                }
                EXPECT_LE(room.depth(), kMicron);
            }
        }
    }
}

/// A tray that consists of several parts: a floor and four walls, open at the top.
scene::Shape tray() {
    scene::Shape shape;
    shape.kind = scene::ShapeKind::compound;
    const auto add = [&](const Vec3& size, const Vec3& position) {
        scene::Part part;
        part.shape = scene::Shape::box(size);
        part.position = position;
        shape.parts.push_back(part);
    };
    add({0.06, 0.06, 0.004}, {0, 0, 0.002});
    for (const double side : {-1.0, 1.0}) {
        add({0.004, 0.06, 0.04}, {side * 0.032, 0, 0.02});
        add({0.068, 0.004, 0.04}, {0, side * 0.032, 0.02});
    }
    return shape;
}

TEST(GodObject, RestsInTheCornerOfATrayAndNeverEntersIt) {
    Room room;
    room.skin = kSkin;
    room.add(tray(), {rotation_xyz({0.3, 0, 0.4}), Vec3::Zero()});
    const Pose& X = room.states[0].X_WB;
    room.start(X * Vec3(0, 0, 0.06));
    room.go(X * Vec3(0, 0, 0.06), X * Vec3(0, 0, 0.01));
    room.go(X * Vec3(0, 0, 0.01), X * Vec3(0.036, 0.037, -0.003));
    EXPECT_LT((room.point->position() - X * Vec3(0.03 - kSkin, 0.03 - kSkin, 0.004 + kSkin)).norm(),
              kMicron);
    EXPECT_EQ(room.point->contacts().size(), 3u);
    for (const PointContact& c : room.point->contacts()) EXPECT_EQ(c.body, 0u);
    // press from inside, wherever the walls can hold the point
    Random random(5, "test");
    for (int i = 0; i < 2000; ++i) {
        const Vec3 h(random.uniform(-0.033, 0.033), random.uniform(-0.033, 0.033),
                     random.uniform(0.001, 0.03));
        room.go(room.point->position(), X * h);
        ASSERT_LE(room.depth(), kMicron) << i;
        const double wall = 0.03 - kSkin;
        const Vec3 nearest(std::clamp(h.x(), -wall, wall), std::clamp(h.y(), -wall, wall),
                           std::max(h.z(), 0.004 + kSkin));
        ASSERT_LT((room.point->position() - X * nearest).norm(), 2 * kMicron) << i;
    }
}

TEST(GodObject, FollowsACompoundAllocatingNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Room room;
    room.add(tray());
    room.start({0, 0, 0.06}, 0.5);
    const testing::AllocationGuard guard;
    room.go({0, 0, 0.06}, {0.036, 0.037, -0.003});
    room.go({0.036, 0.037, -0.003}, {-0.036, 0.01, -0.003});
    EXPECT_EQ(guard.count(), 0u);
}

/// If a step leaves a point a micrometre deep in two bodies that pinch it, the point stays there
/// instead of slipping out between the bodies, millimetres away.
TEST(Move, LeavesAPointWhereAStepPinchesIt) {
    Room room;
    room.skin = kSkin;
    room.add(scene::Shape::box({0.1, 0.1, 0.02}), {Quat::Identity(), {0, 0, -0.01}});
    const Quat tilted(Eigen::AngleAxisd(0.002, Vec3::UnitY()));
    room.add(scene::Shape::box({0.04, 0.04, 0.02}), {tilted, {0, 0, 0.012}});
    const Vec3 p(0.001, 0, kSkin);
    room.start(p);
    // the upper body approaches the point until the gap is 1 um too small
    const double low = (tilted * Vec3(0, 0, -0.01 - kSkin)).z();
    room.states[1].X_WB.p.z() = kSkin - 1e-6 - low - p.x() * std::tan(0.002);
    room.point->move(p, room.states);
    EXPECT_LT((room.point->position() - p).norm(), 2e-6);
    // both bodies are still felt
    const auto met = room.point->obstacles(p, room.states, 1e-3);
    EXPECT_EQ(met.size(), 2u);
    for (const Obstacle& o : met) EXPECT_NEAR(std::abs(o.n_W.z()), 1, 1e-5);
}

}  // namespace
}  // namespace dihaptic::haptics::god_object_test
