#include "dynamics/world.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include "base/unit.h"
#include "dynamics/test/blocks.h"
#include "testing/allocation_guard.h"

namespace dihaptic::dynamics::world_test {
namespace {

void run(World& world, double time) {
    for (double t = kStep / 2; t < time; t += kStep) world.step(kStep);
}

TEST(World, FallsFreelyByTheClosedFormOfItsIntegrator) {
    World world = make({block({0, 0, 1})});
    run(world, 0.3);
    EXPECT_NEAR(world.states()[0].X_WB.p.z(), 1 - kGravity * kStep * kStep * 300 * 301 / 2, 1e-12);
    EXPECT_NEAR(world.states()[0].v_WB.z(), -kGravity * 0.3, 1e-12);
}

TEST(World, AForceOffTheCentreTurnsABlock) {
    // at the midpoint of a face's edge: w = h r x f / I, with I = m a^2 / 6 for a cube
    World world = make({block({0.3, 0.2, 1})});
    const Vec3 r(0.02, 0, 0.02);
    const Vec3 f(0, 0.5, 0);
    world.apply_at({0}, f, Vec3(0.3, 0.2, 1) + r);
    world.step(kStep);
    const double inertia = 0.1 * 0.04 * 0.04 / 6;
    EXPECT_LT((world.states()[0].w_WB - kStep / inertia * r.cross(f)).norm(), 1e-9);
    EXPECT_NEAR(world.states()[0].v_WB.y(), kStep * 0.5 / 0.1, 1e-12);
}

TEST(World, ContactForcesCarryTheWeight) {
    World world = make({table(), block({0, 0, 0.02})}, awake());
    run(world, 0.5);
    Vec3 force = Vec3::Zero();
    ASSERT_EQ(world.contacts().size(), 4u);
    for (const contact::Contact& c : world.contacts()) {
        EXPECT_EQ(c.a, BodyIndex{0});
        EXPECT_EQ(c.b, BodyIndex{1});
        EXPECT_LT((c.n_W - Vec3::UnitZ()).norm(), 1e-9);
        EXPECT_DOUBLE_EQ(c.friction, 0.8);
        force += c.f_B_W;
    }
    EXPECT_LT((force - Vec3(0, 0, 0.1 * kGravity)).norm(), 1e-6);
    EXPECT_NEAR(world.states()[1].X_WB.p.z(), 0.02, 1e-9);
}

TEST(World, FallsOntoTheTableWithoutPassingOrBouncing) {
    World world = make({table(), block({0, 0, 0.12})}, awake());
    double lowest = 1, highest_after = 0;
    for (int i = 0; i < 600; ++i) {
        world.step(kStep);
        lowest = std::min(lowest, world.states()[1].X_WB.p.z());
        if (i > 200) highest_after = std::max(highest_after, world.states()[1].X_WB.p.z());
    }
    EXPECT_GT(lowest, 0.02 - 1e-6);
    EXPECT_LT(highest_after, 0.02 + 1e-6);
}

TEST(World, StepChangesMomentumByLoadsAndContactForces) {
    // the forces reported for the contacts must be those that acted
    World world = make({table(0.3), block({0, 0, 0.02}, 0.3)}, awake());
    for (int i = 0; i < 200; ++i) {
        const Vec3 before = 0.1 * world.states()[1].v_WB;
        const Vec3 load(0.4, 0.1, 0);
        world.apply({1}, load, Vec3::Zero());
        world.step(kStep);
        Vec3 force = load + 0.1 * world.gravity();
        for (const contact::Contact& c : world.contacts()) force += c.f_B_W;
        EXPECT_LT((0.1 * world.states()[1].v_WB - before - kStep * force).norm(), 1e-12);
    }
}

TEST(World, SlidesWithCoulombFrictionOfThePair) {
    World world = make({table(0.9), block({0, 0, 0.02}, 0.4)}, awake());  // sqrt(0.36) = 0.6
    world.set_velocity({1}, {1, 0.5, 0});
    const double speed = std::hypot(1, 0.5);
    run(world, 0.1);
    EXPECT_NEAR(world.states()[1].v_WB.norm(), speed - 0.6 * kGravity * 0.1, 2e-3);
    run(world, 0.5);
    EXPECT_NEAR(world.states()[1].X_WB.p.head<2>().norm(), speed * speed / (2 * 0.6 * kGravity),
                2e-3);
    EXPECT_LT(world.states()[1].v_WB.norm(), 1e-9);
}

TEST(World, SlopesHoldBelowTheFrictionAngleAndReleaseAbove) {
    for (const double degrees : {26.0, 27.0}) {
        const Quat R = rotation_xyz({0, degrees * kDegree, 0});
        scene::Body slope = box("slope", {5, 1, 0.1}, R * Vec3(0, 0, -0.05), 0, 0.5);
        scene::Body load = block(R * Vec3(0, 0, 0.02), 0.5);
        slope.rotation.y() = load.rotation.y() = degrees * kDegree;
        World world = make({slope, load}, awake());
        const Vec3 start = world.states()[1].X_WB.p;
        run(world, 1);
        const double moved = (world.states()[1].X_WB.p - start).norm();
        const double a =
            kGravity * (std::sin(degrees * kDegree) - 0.5 * std::cos(degrees * kDegree));
        if (a < 0) {
            EXPECT_LT(moved, 1e-6);
        } else {
            EXPECT_NEAR(moved / (a / 2), 1, 0.01);
        }
    }
}

TEST(World, BodiesMoveOnlyAlongTheirFreeAxes) {
    scene::Body bead = block({0, 0, 0.2});
    bead.moves = scene::Axes::z;
    bead.turns = scene::Axes::none;
    World world = make({bead});
    world.apply({0}, {1, 1, 2}, {0.1, 0.1, 0.1});
    world.step(kStep);
    EXPECT_EQ(world.states()[0].v_WB.x(), 0);
    EXPECT_EQ(world.states()[0].v_WB.y(), 0);
    EXPECT_NEAR(world.states()[0].v_WB.z(), kStep * (2 / 0.1 - kGravity), 1e-12);
    EXPECT_EQ(world.states()[0].w_WB, Vec3::Zero());
}

TEST(World, ABodyOnAHingeTurnsByItsInertiaAboutIt) {
    scene::Body bar = box("bar", {0.1, 0.02, 0.03}, {0, 0, 0.2}, 0.2);
    bar.rotation = {0.4, 0.3, 0.2};  // not aligned with the world's axes
    bar.moves = scene::Axes::none;
    bar.turns = scene::Axes::z;
    World world = make({bar});
    world.apply({0}, Vec3::Zero(), {0.3, 0.2, 0.1});
    world.step(kStep);
    const Mat3 I = 0.2 / (0.1 * 0.02 * 0.03) * scene::integrate(bar.shape).inertia;
    const Mat3 R = bar.pose().R.toRotationMatrix();
    EXPECT_NEAR(world.states()[0].w_WB.z(), kStep * 0.1 / (R * I * R.transpose())(2, 2), 1e-9);
    EXPECT_EQ(world.states()[0].w_WB.x(), 0);
}

TEST(World, ATumblingBodyKeepsItsEnergyAndAngularMomentum) {
    scene::Scene scene;
    scene.gravity.setZero();
    scene.bodies = {box("bar", {0.1, 0.05, 0.02}, {0, 0, 0}, 0.2)};
    World world(scene, {});
    world.activate();
    const Vec3 inertia =
        (0.2 / (0.1 * 0.05 * 0.02) * scene::integrate(scene.bodies[0].shape).inertia).diagonal();
    world.apply({0}, Vec3::Zero(),
                Vec3(inertia.cwiseProduct(Vec3(2, 5, 3)) / kStep));  // spins about all axes
    world.step(kStep);
    const auto momentum = [&] {
        const BodyState& s = world.states()[0];
        return Vec3(s.X_WB.R * inertia.cwiseProduct(s.X_WB.R.conjugate() * s.w_WB));
    };
    const Vec3 start = momentum();
    run(world, 2);
    EXPECT_NEAR(momentum().norm() / start.norm(), 1, 0.02);
    EXPECT_GT(momentum().dot(start) / start.squaredNorm(), 0.98);
}

TEST(World, AMeshTurnsAboutItsCentreOfMassWhereverItsFilePutsIt) {
    scene::Body off = block({0, 0, 0.5});
    scene::Body mesh = off;
    mesh.shape.kind = scene::ShapeKind::mesh;
    mesh.shape.hull = scene::convex_hull([] {
        std::vector<Vec3> corners;
        for (int i = 0; i < 8; ++i)
            corners.emplace_back(0.1 + 0.04 * (i & 1), 0.2 + 0.04 * (i >> 1 & 1),
                                 0.04 * (i >> 2 & 1));
        return corners;
    }());
    World world = make({mesh});
    world.apply({0}, {0, 0, 0.1 * kGravity}, {0.01, 0.02, 0.03});
    world.step(kStep);
    const BodyState& state = world.states()[0];
    const Vec3 centre(0.12, 0.22, 0.02);
    const Vec3 v_centre = state.v_WB + state.w_WB.cross(state.X_WB.R * centre);
    EXPECT_LT(v_centre.norm(), 1e-9);
    EXPECT_LT((state.w_WB - kStep * Vec3(0.01, 0.02, 0.03) / (0.1 * 0.04 * 0.04 / 6)).norm(), 1e-6);
}

TEST(World, RoundShapesRestOnAPlaneWhereTheyShould) {
    scene::Body plane;
    plane.name = "plane";
    plane.shape.kind = scene::ShapeKind::plane;
    plane.fixed = true;
    scene::Body ball = block({0, 0, 0.015});
    ball.shape = scene::Shape::sphere(0.015);
    scene::Body can = block({0.2, 0, 0.025});
    can.name = "can";
    can.shape.kind = scene::ShapeKind::cylinder;
    can.shape.radius = 0.02;
    can.shape.length = 0.05;
    scene::Body pill = block({0.4, 0, 0.02});
    pill.name = "pill";
    pill.shape.kind = scene::ShapeKind::capsule;
    pill.shape.radius = 0.01;
    pill.shape.length = 0.02;
    World world = make({plane, ball, can, pill}, awake());
    run(world, 1);
    EXPECT_NEAR(world.states()[1].X_WB.p.z(), 0.015, 1e-5);
    EXPECT_NEAR(world.states()[2].X_WB.p.z(), 0.025, 1e-4);
    EXPECT_NEAR(world.states()[3].X_WB.p.z(), 0.02, 1e-4);
}

/// Steps for `time` and returns the smallest height that any of a body's `points` reaches.
double lowest_of(World& world, int body, const std::vector<Vec3>& points, double time) {
    double lowest = 1;
    for (double t = kStep / 2; t < time; t += kStep) {
        world.step(kStep);
        for (const Vec3& p : points)
            lowest = std::min(lowest, (world.states()[static_cast<size_t>(body)].X_WB * p).z());
    }
    return lowest;
}

TEST(World, ABallMeetsABoxesCornerWhereItIs) {
    const double radius = 0.008;
    const Vec3 away = Vec3::Ones().normalized();
    scene::Body ball = block({0, 0, 0});
    ball.shape = scene::Shape::sphere(radius);
    const double gap = 3e-4;
    ball.position = Vec3::Constant(0.02) + (radius + gap) * away;
    World world = make({box("box", Vec3::Constant(0.04), Vec3::Zero(), 0), ball}, awake());
    world.step(kStep);
    ASSERT_EQ(world.contacts().size(), 1u);
    EXPECT_NEAR(world.contacts()[0].gap, gap, 1e-12);
    EXPECT_GT(world.contacts()[0].n_W.dot(away), 1 - 1e-12);
}

TEST(World, BallsThatFlyAtEachOtherNeverOverlap) {
    for (const double speed : {1.0, 3.0, 9.0}) {
        std::vector<scene::Body> balls{block({-0.1, 0, 1}), block({0.1, 0.002, 1})};
        for (scene::Body& ball : balls) ball.shape = scene::Shape::sphere(0.01);
        balls[1].name = "other";
        World world = make(balls, awake());
        world.set_velocity({0}, {speed, 0, 0});
        world.set_velocity({1}, {-speed, 0, 0});
        double nearest = 1;
        for (int i = 0; i < 150; ++i) {
            world.step(kStep);
            nearest =
                std::min(nearest, (world.states()[0].X_WB.p - world.states()[1].X_WB.p).norm());
        }
        EXPECT_GT(nearest, 0.02 - 2e-4) << speed;
        EXPECT_LT(nearest, 0.02 + 2e-4) << speed;
    }
}

TEST(World, ABoxThatSpinsIntoTheTableDoesNotSinkIn) {
    World world = make({table(), block({0, 0, 0.032})}, awake());
    const double inertia = 0.1 * 0.04 * 0.04 / 6;
    world.apply({1}, Vec3::Zero(), Vec3(0, 60 * inertia / kStep, 0));
    EXPECT_GT(lowest_of(world, 1, scene::marks(scene::Shape::box(Vec3::Constant(0.04))), 0.3),
              -2e-4);
}

TEST(Sleep, RestingBodiesSleepAndStayExactlyWhereTheyAre) {
    World world =
        make({table(), block({0, 0, 0.02}), box("other", Vec3::Constant(0.04), {0, 0, 0.06}, 0.1)});
    run(world, 1.5);
    EXPECT_FALSE(world.states()[1].awake);
    EXPECT_FALSE(world.states()[2].awake);
    const Vec3 where = world.states()[2].X_WB.p;
    run(world, 1);
    EXPECT_EQ(world.states()[2].X_WB.p, where);
    EXPECT_TRUE(world.stepped().empty());
}

TEST(World, AFixedBodyThatIsPutElsewhereNoLongerCarriesAndLaterDoes) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    scene::Body shelf = box("shelf", {0.1, 0.1, 0.02}, {0, 0, 0.19}, 0);
    shelf.fixed = true;
    World world = make({table(), shelf, block({0, 0, 0.22})});
    run(world, 1.5);
    ASSERT_FALSE(world.states()[2].awake);
    const testing::AllocationGuard guard;
    world.set_pose({1}, {Quat::Identity(), {0.5, 0, 0.19}});
    world.step(kStep);
    const auto noted = [&] {
        return std::count(world.stepped().begin(), world.stepped().end(), 1u);
    };
    EXPECT_EQ(noted(), 1);
    EXPECT_EQ(world.states()[1].X_WB.p, Vec3(0.5, 0, 0.19));
    for (int i = 2; i <= 50; ++i) {
        world.step(kStep);
        EXPECT_NEAR(world.states()[2].X_WB.p.z(), 0.22 - kGravity * kStep * kStep * i * (i + 1) / 2,
                    1e-9);
    }
    EXPECT_EQ(noted(), 0);
    // after being moved into the path of the falling block, the shelf carries the block again
    world.set_pose({1}, {Quat::Identity(), {0, 0, 0.13}});
    run(world, 0.5);
    EXPECT_NEAR(world.states()[2].X_WB.p.z(), 0.16, 1e-5);
    EXPECT_EQ(guard.count(), 0u);
}

TEST(Sleep, ALoadWakesABodyAndAllThatItTouches) {
    World world =
        make({table(), block({0, 0, 0.02}), box("other", Vec3::Constant(0.04), {0, 0, 0.06}, 0.1)});
    run(world, 1.5);
    world.apply({2}, {0, 0, 0.1}, Vec3::Zero());
    world.step(kStep);
    EXPECT_TRUE(world.states()[1].awake);
    EXPECT_TRUE(world.states()[2].awake);
    EXPECT_LT(std::abs(world.states()[2].v_WB.z()), 1e-6);  // still carried
}

TEST(Sleep, WhatFallsOnASleeperWakesItInTheSameStep) {
    World world = make(
        {table(), block({0, 0, 0.02}), box("falling", Vec3::Constant(0.04), {0, 0, 1.5}, 0.1)});
    bool slept = false;
    for (int i = 0; i < 1000 && world.states()[2].v_WB.z() <= 0; ++i) {
        const double falling = world.states()[2].v_WB.z();
        slept = slept || !world.states()[1].awake;
        world.step(kStep);
        if (world.states()[2].v_WB.z() > falling + 1) break;  // the box has landed
    }
    EXPECT_TRUE(slept);
    EXPECT_TRUE(world.states()[1].awake);
    EXPECT_GT(world.states()[1].X_WB.p.z(), 0.02 - 1e-4);
}

TEST(Sleep, NeverFreezesAnythingThatSlides) {
    // friction is just below the value that would stop the block, which creeps down at a few mm/s
    // for seconds
    const double slope = 26.6 * kDegree;  // tan = 0.5008
    const Quat R = rotation_xyz({0, slope, 0});
    scene::Body plane = box("slope", {5, 1, 0.1}, R * Vec3(0, 0, -0.05), 0, 0.5);
    scene::Body load = block(R * Vec3(0, 0, 0.02), 0.5);
    plane.rotation.y() = load.rotation.y() = slope;
    World world = make({plane, load});
    const Vec3 start = world.states()[1].X_WB.p;
    run(world, 4);
    const double a = kGravity * (std::sin(slope) - 0.5 * std::cos(slope));
    EXPECT_TRUE(world.states()[1].awake);
    EXPECT_NEAR((world.states()[1].X_WB.p - start).norm() / (a * 16 / 2), 1, 0.1);
}

TEST(Sleep, NothingThatAFingerTouchesSleeps) {
    scene::Scene scene;
    scene.bodies = {table(), block({0, 0, 0.02})};
    World world(scene, {});
    scene::Finger finger;
    finger.name = "index";
    finger.shape = scene::Shape::box({0.005, 0.02, 0.02});
    const BodyIndex proxy = world.add_proxy(finger, {-0.0225, 0, 0.02});
    world.activate();
    for (int i = 0; i < 1500; ++i) {
        world.set_velocity(proxy, {1e-3, 0, 0});  // pressing gently
        world.step(kStep);
    }
    EXPECT_TRUE(world.states()[1].awake);
}

TEST(World, ProxiesFeelNoGravityAndDoNotTurn) {
    scene::Scene scene;
    scene.bodies = {block({0, 0, 1})};
    World world(scene, {});
    scene::Finger finger;
    finger.name = "index";
    finger.shape = scene::Shape::sphere(0.01);
    const BodyIndex proxy = world.add_proxy(finger, {1, 0, 0});
    world.activate();
    world.apply(proxy, Vec3::Zero(), {1, 1, 1});
    run(world, 0.1);
    EXPECT_EQ(world.state(proxy).X_WB.p, Vec3(1, 0, 0));
    EXPECT_EQ(world.state(proxy).w_WB, Vec3::Zero());
}

/// A world with blocks thrown together, in which many contacts come and go.
World heap() {
    std::vector<scene::Body> bodies{table()};
    for (int i = 0; i < 20; ++i) {
        scene::Body b = block({0.03 * (i % 3), 0.02 * (i % 2), 0.05 + 0.05 * i});
        b.name = "block " + number_text(i);
        b.rotation = {0.1 * i, 0.2 * i, 0};
        bodies.push_back(b);
    }
    return make(bodies);
}

TEST(World, RepeatsItselfToTheBit) {
    World a = heap();
    World b = heap();
    for (int i = 0; i < 1500; ++i) {
        a.step(kStep);
        b.step(kStep);
    }
    for (size_t i = 0; i < a.states().size(); ++i) {
        EXPECT_EQ(a.states()[i].X_WB.p, b.states()[i].X_WB.p);
        EXPECT_EQ(a.states()[i].X_WB.R.coeffs(), b.states()[i].X_WB.R.coeffs());
    }
}

TEST(World, StepsWithoutAllocatingFromTheFirstStepOn) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    World world = heap();
    const testing::AllocationGuard guard;
    for (int i = 0; i < 2000; ++i) world.step(kStep);
    EXPECT_EQ(guard.count(), 0u);
}

TEST(World, StepsWithoutAllocatingWithRoundShapesToo) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    std::vector<scene::Body> bodies{table()};
    for (int i = 0; i < 15; ++i) {
        scene::Body b = block({0.03 * (i % 3), 0.02 * (i % 2), 0.05 + 0.05 * i});
        b.name = "thing " + number_text(i);
        b.shape.kind = std::array{scene::ShapeKind::sphere, scene::ShapeKind::capsule,
                                  scene::ShapeKind::cylinder, scene::ShapeKind::cone,
                                  scene::ShapeKind::box}[static_cast<size_t>(i % 5)];
        b.shape.radius = 0.015;
        b.shape.length = 0.03;
        bodies.push_back(b);
    }
    World world = make(bodies);
    const testing::AllocationGuard guard;
    for (int i = 0; i < 2000; ++i) world.step(kStep);
    EXPECT_EQ(guard.count(), 0u);
}

TEST(World, TheAllocationGuardSeesWhatAStepWouldAllocate) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    frame::DynamicsSettings settings;
    settings.max_contacts = 4;  // far too few: the step must allocate memory and report it
    std::vector<scene::Body> bodies{table()};
    for (int i = 0; i < 80; ++i) {
        bodies.push_back(block({0.05 * (i % 10) - 0.25, 0.05 * (i / 10) - 0.2, 0.02}));
        bodies.back().name = "block " + number_text(i);
    }
    World world = make(bodies, settings);
    const testing::AllocationGuard guard;
    EXPECT_EQ(world.step(kStep), StepStatus::contacts_full);
    EXPECT_GT(guard.count(), 0u);
}

}  // namespace
}  // namespace dihaptic::dynamics::world_test
