// Tests a million steps of random mechanisms that are pushed together, dropped and jammed: nothing
// diverges, every miss of the solver is reported, joints hold, and no energy is created.
#include <gtest/gtest.h>

#include <cstdio>

#include "base/number.h"
#include "base/random.h"
#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics::mechanisms_soak {
namespace {

constexpr int kScenes = 1000;
constexpr int kSteps = 1000;

Vec3 random_vector(Random& random, double size) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// Bodies above a table that are joined into a tree or sometimes a loop, and two jaws.
struct Mechanism {
    scene::Scene scene;
    size_t jaws = 0;  // index of the first jaw

    explicit Mechanism(Random& random) {
        scene.bodies.push_back(table());
        const int count = 2 + static_cast<int>(random.uniform(0, 6));
        for (int i = 0; i < count; ++i) {
            const double mass = std::pow(10, random.uniform(-2.5, -0.3));
            scene::Body body = box(
                "body " + number_text(i), Vec3::Constant(0.04) + random_vector(random, 0.02),
                {0.07 * i - 0.03 * count, random.uniform(-0.01, 0.01), random.uniform(0.05, 0.2)},
                mass, random.uniform(0, 1));
            body.rotation = random_vector(random, 0.3);
            give_surface(random, body);
            scene.bodies.push_back(body);
        }
        for (int i = 1; i < count; ++i) join(random, i, static_cast<int>(random.uniform(0, i)));
        if (random.uniform(0, 1) < 0.3) join(random, 0, -1);
        if (random.uniform(0, 1) < 0.3) join(random, count - 1, 0);
        jaws = scene.bodies.size();
        for (const double side : {-1.0, 1.0})
            scene.bodies.push_back(box(side < 0 ? "left jaw" : "right jaw", {0.02, 0.1, 0.1},
                                       {0.35 * side, 0, 0.1}, 0.2));
        for (size_t i = jaws; i < scene.bodies.size(); ++i) {
            scene.bodies[i].moves = scene::Axes::xz;
            scene.bodies[i].turns = scene::Axes::none;
        }
    }

  private:
    static void give_surface(Random& random, scene::Body& body) {
        const double which = random.uniform(0, 4);
        if (which < 1) {
            body.surface.stiffness = std::pow(10, random.uniform(2, 5));
            body.surface.damping = random.uniform(0, 5);
        } else if (which < 2) {
            body.surface.restitution = random.uniform(0, 1);
        } else if (which < 3) {
            body.surface.dynamic_friction = random.uniform(0, body.friction);
            body.surface.film = random.uniform(0, 3);
        }
    }
    /// Joins two bodies; -1 is the world.
    void join(Random& random, int a, int b) {
        scene::Joint joint;
        joint.name = "joint " + number_text(scene.joints.size());
        joint.kind = static_cast<scene::JointKind>(static_cast<int>(random.uniform(0, 6)));
        const auto name = [](int i) { return "body " + number_text(i); };
        const scene::Body& first = scene.bodies[static_cast<size_t>(a) + 1];
        joint.between = {name(a)};
        if (b >= 0) joint.between.push_back(name(b));
        joint.position = first.position + random_vector(random, 0.02);
        joint.axis = random_vector(random, 1).normalized();
        joint.second_axis = joint.axis.unitOrthogonal();
        if (joint.is_distance())
            joint.second_position = b >= 0 ? scene.bodies[static_cast<size_t>(b) + 1].position
                                           : Vec3(joint.position + Vec3(0, 0, 0.1));
        if (joint.has_coordinate() && random.uniform(0, 1) < 0.5) {
            const double size = joint.slides() ? 1000 : 1;
            joint.stiffness = size * std::pow(10, random.uniform(-2, 1));
            joint.damping = 1e-3 * size * random.uniform(0, 1);
            joint.friction = joint.is_distance() ? 0 : 1e-3 * size * random.uniform(0, 0.3);
            if (!joint.is_distance()) {
                joint.low = joint.slides() ? -0.02 : -0.5;
                joint.high = joint.slides() ? 0.02 : 0.5;
            } else {
                joint.rest = (*joint.second_position - joint.position).norm();
            }
        }
        scene.joints.push_back(joint);
    }
};

class MechanismsSoak : public ::testing::TestWithParam<contact::Solver> {};
INSTANTIATE_TEST_SUITE_P(World, MechanismsSoak, ::testing::Values(contact::Solver::newton),
                         [](const auto& which) {
                             return std::string(
                                 enum_names(contact::Solver{})[static_cast<size_t>(which.param)]);
                         });

TEST_P(MechanismsSoak, AMillionStepsHarmNothing) {
    frame::DynamicsSettings settings = awake();
    settings.solver = GetParam();
    int missed = 0;
    double fastest = 0;
    double worst_unreported = 0;
    for (int n = 0; n < kScenes; ++n) {
        Random random(static_cast<uint64_t>(n), "mechanisms");
        const Mechanism mechanism(random);
        World world(mechanism.scene, settings);
        world.activate();
        const auto jaw = static_cast<int>(mechanism.jaws);
        const double squeeze = random.uniform(2, 20);
        const double lift = random.uniform(1, 3);  // relative to the weight of the jaws
        for (int i = 0; i < kSteps; ++i) {
            // the jaws close, lift, and open again
            const double close = i < 700 ? squeeze : -squeeze;
            const double up = (i > 300 && i < 700 ? lift : 1) * 0.2 * kGravity;
            world.apply({jaw}, {close, 0, up}, Vec3::Zero());
            world.apply({jaw + 1}, {-close, 0, up}, Vec3::Zero());
            const StepStatus status = world.step(kStep);
            ASSERT_NE(status, StepStatus::diverged) << n << " " << i;
            missed += world.solve_stats().missed;
            if (!world.solve_stats().missed)
                worst_unreported = std::max(worst_unreported, world.solve_stats().residual);
            for (const BodyState& state : world.states()) {
                ASSERT_TRUE(state.X_WB.p.allFinite() && state.v_WB.allFinite()) << n << " " << i;
                fastest = std::max(fastest, state.v_WB.norm());
            }
        }
    }
    // in 0.7 s without an obstacle, 20 N accelerate a jaw of 0.2 kg to 70 m/s
    EXPECT_LT(fastest, 70);
    EXPECT_LE(worst_unreported, 1.0001e-8);
    EXPECT_LT(missed, kScenes * kSteps / 100);
    std::printf("misses, all reported: %d of %d; fastest %.1f m/s; worst residual otherwise %.1e\n",
                missed, kScenes * kSteps, fastest, worst_unreported);
}

}  // namespace
}  // namespace dihaptic::dynamics::mechanisms_soak
