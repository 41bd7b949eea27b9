// What one finger feels, against mechanics.
#include <gtest/gtest.h>

#include "measure/plant.h"

namespace dihaptic::measure {
namespace {

constexpr double kGravity = 9.81;

TEST(Felt, PushingABlockIsItsMassTimesAccelerationPlusFriction) {
    BenchSetup setup;
    setup.friction = 0.3;
    scene::Scene scene = grasp_scene(setup);
    scene.fingers.resize(1);
    hand::HandSpec hand;
    hand.centre = {-0.03, 0, 0.02};
    hand.script = {{"push", 1, {}, {0.2, 0, 0}, false}, {"stop", 0.3, {}, Vec3::Zero(), false}};
    Bench bench(scene, hand, setup);
    Vec3 v_before = Vec3::Zero();
    int compared = 0;
    double last_ratio = 0;
    bench.run([&](const servo::Frame& frame) {
        const Vec3 v = frame.bodies[1].v_WB;
        const double force = -frame.fingers[0].f_sent_W.x();
        const double expected = setup.mass * (v.x() - v_before.x()) / setup.settings.tick() +
                                setup.friction * setup.mass * kGravity;
        // while it is pushed and slides; the first ticks of touch bring it from rest to speed
        if (v.x() > 0.05 && v_before.x() > 0.05 && force > 0.1) {
            EXPECT_NEAR(force / expected, 1, 0.01) << seconds(frame.time);
            last_ratio = force / expected;
            ++compared;
        }
        v_before = v;
    });
    EXPECT_GT(compared, 300) << last_ratio;
}

TEST(Felt, LiftingABeadOnItsStringIsItsWeight) {
    BenchSetup setup;
    scene::Scene scene;
    scene::Body bead;
    bead.name = "bead";
    bead.shape = scene::Shape::sphere(0.015);
    bead.mass = 0.08;
    bead.position = {0, 0, 0.06};
    bead.moves = scene::Axes::z;
    bead.turns = scene::Axes::none;
    scene::Body shelf;
    shelf.name = "shelf";
    shelf.shape = scene::Shape::box({0.01, 0.04, 0.004});
    shelf.position = {-0.014, 0, 0.046};
    shelf.fixed = true;
    scene.bodies = {bead, shelf};
    scene::Finger finger;
    finger.name = "index";
    finger.shape = scene::Shape::box({0.012, 0.012, 0.005});
    scene.fingers = {finger};
    hand::HandSpec hand;
    hand.centre = {0, 0, 0.03};
    hand.script = {{"lift", 1, {}, {0, 0, 0.06}, false}, {"hold", 2, {}, Vec3::Zero(), false}};
    Bench bench(scene, hand, setup);
    analysis::GraspTrace trace(0, setup.settings.tick());
    bench.run([&](const servo::Frame& frame) { trace.add(frame); });
    EXPECT_NEAR(trace.weight_felt(trace.between(2, 3)) / (0.08 * kGravity), 1, 0.005);
    EXPECT_GT(trace.samples().back().X_WB.p.z(), 0.08);
}

TEST(Felt, AFrictionlessPlaneIsStiffnessTimesDepthAndNothingAcross) {
    BenchSetup setup;
    scene::Scene scene;
    scene::Body plane;
    plane.name = "plane";
    plane.shape.kind = scene::ShapeKind::plane;
    plane.fixed = true;
    plane.friction = 0;
    scene.bodies = {plane};
    scene::Finger finger;
    finger.name = "index";
    finger.shape = scene::Shape::sphere(0.008);
    scene.fingers = {finger};
    hand::HandSpec hand;
    hand.centre = {0, 0, 0.03};
    hand.script = {{"press", 1, {}, {0, 0, -0.03}, false}, {"slide", 1, {}, {0.2, 0, 0}, false}};
    Bench bench(scene, hand, setup);
    bench.run([&](const servo::Frame& frame) {
        const servo::FingerFrame& f = frame.fingers[0];
        // nothing but the proxy's own gram, at the peak acceleration of minimum jerk over 0.2 m in
        // 1 s
        EXPECT_LT(f.f_sent_W.head<2>().norm(), 1.02 * scene.fingers[0].mass * 5.774 * 0.2);
        if (seconds(frame.time) > 1.2) {
            EXPECT_NEAR(f.f_sent_W.z() / (1000 * (0.008 - f.p_WH.z())), 1, 0.005);
        }
    });
}

}  // namespace
}  // namespace dihaptic::measure
