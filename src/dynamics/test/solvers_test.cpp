// Tests World with each of its solvers.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/number.h"
#include "dynamics/test/blocks.h"
#include "dynamics/test/energy_scenes.h"
#include "testing/allocation_guard.h"

namespace dihaptic::dynamics::solvers_test {
namespace {

class EachSolver : public ::testing::TestWithParam<contact::Solver> {
  protected:
    World world_of(std::vector<scene::Body> bodies) const {
        frame::DynamicsSettings settings = awake();
        settings.solver = GetParam();
        return make(std::move(bodies), settings);
    }
};
INSTANTIATE_TEST_SUITE_P(
    World, EachSolver,
    ::testing::Values(contact::Solver::sequential_impulse, contact::Solver::stewart_trinkle,
                      contact::Solver::staggered_projections, contact::Solver::newton),
    [](const auto& which) {
        return std::string(enum_names(contact::Solver{})[static_cast<size_t>(which.param)]);
    });

TEST_P(EachSolver, SlidesAsFarAsCoulombSays) {
    World world = world_of({table(0.5), block({0, 0, 0.02}, 0.5)});
    world.set_velocity({1}, {0.6, 0.3, 0});
    const double speed = std::hypot(0.6, 0.3);
    for (int i = 0; i < 400; ++i) world.step(kStep);
    // with semi-implicit Euler, the block stops half a step's path early
    const double distance = speed * speed / (2 * 0.5 * kGravity);
    EXPECT_NEAR(world.states()[1].X_WB.p.head<2>().norm(), distance, 0.6 * speed * kStep);
    EXPECT_LT(world.states()[1].v_WB.norm(), 1e-8);
}

TEST_P(EachSolver, NeverGainsEnergy) {
    // the soak test has hundreds of scenes
    frame::DynamicsSettings settings;
    settings.solver = GetParam();
    for (uint64_t seed = 0; seed < 8; ++seed) {
        EnergyScene scene(seed, settings);
        for (int i = 0; i < 1000; ++i) {
            const double rise = scene.step();
            // bodies that overlap are pushed apart, which adds energy
            EXPECT_TRUE(rise <= 1e-6 || scene.overlapped()) << "scene " << seed << ", step " << i;
        }
    }
}

TEST_P(EachSolver, StepsWithoutAllocating) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    std::vector<scene::Body> bodies{table()};
    for (int i = 0; i < 12; ++i) {
        bodies.push_back(box("block " + number_text(i), Vec3::Constant(0.04),
                             {0.02 * (i % 3), 0.01 * (i % 2), 0.021 + 0.042 * i}, 0.1));
    }
    World world = world_of(bodies);
    dihaptic::testing::AllocationGuard guard;
    for (int i = 0; i < 400; ++i) world.step(kStep);
    EXPECT_EQ(guard.count(), 0u);
}

TEST_P(EachSolver, RepeatsItselfToTheBit) {
    const auto end = [&] {
        World world = world_of({table(), box("a", Vec3::Constant(0.04), {0, 0, 0.03}, 0.1),
                                box("b", Vec3::Constant(0.04), {0.013, 0.01, 0.08}, 0.1)});
        for (int i = 0; i < 500; ++i) world.step(kStep);
        return std::vector<BodyState>(world.states().begin(), world.states().end());
    };
    const std::vector<BodyState> first = end();
    const std::vector<BodyState> second = end();
    for (size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].X_WB.p, second[i].X_WB.p);
        EXPECT_EQ(first[i].X_WB.R.coeffs(), second[i].X_WB.R.coeffs());
    }
}

TEST_P(EachSolver, TellsItsResidual) {
    World world = world_of({table(), block({0, 0, 0.02})});
    for (int i = 0; i < 50; ++i) {
        world.apply({1}, {0.3, 0, 0}, Vec3::Zero());
        world.step(kStep);
        EXPECT_LT(world.solve_stats().residual,
                  GetParam() == contact::Solver::sequential_impulse ? 1e-5 : 1e-8);
        EXPECT_FALSE(world.solve_stats().fallback);
    }
    EXPECT_EQ(world.contacts().size(), 4u);
}

TEST(Solvers, ChangeWhileRunningWithoutAJump) {
    World world = make({table(), box("lower", Vec3::Constant(0.04), {0, 0, 0.02}, 0.1),
                        box("upper", Vec3::Constant(0.04), {0.005, 0, 0.06}, 0.1)},
                       awake());
    for (int i = 0; i < 800; ++i) {
        if (i % 100 == 0)
            world.set_solver(static_cast<contact::Solver>(i / 100 % contact::kSolvers));
        world.step(kStep);
        double force = 0;
        for (const contact::Contact& c : world.contacts()) {
            if (c.a == BodyIndex{0}) force += c.f_B_W.z();
        }
        EXPECT_NEAR(force, 0.2 * kGravity, 1e-3) << i;
    }
    EXPECT_NEAR(world.states()[2].X_WB.p.z(), 0.06, 1e-6);
}

/// A world with a rod held by one end between two soft spheres, each of which is pressed with
/// `press`.
World held_rod(contact::Solver solver, double radius) {
    scene::Scene scene;
    scene::Body rod = box("rod", {0.01, 0.2, 0.01}, {0, 0.09, 0.3}, 0.02);
    scene.bodies = {table(), rod};
    frame::DynamicsSettings settings = awake();
    settings.solver = solver;
    World world(scene, settings);
    for (const double side : {-1.0, 1.0}) {
        scene::Finger finger;
        finger.name = side < 0 ? "left" : "right";
        finger.shape = scene::Shape::sphere(0.01);
        finger.mass = 1;
        finger.torsion_radius = radius;
        world.add_proxy(finger, {side * (0.005 + 0.01), 0, 0.3});
    }
    world.activate();
    return world;
}
double turned_after(World& world, double press, double time) {
    for (double t = kStep / 2; t < time; t += kStep) {
        // the fingers stay at the same height; the spheres' friction carries the rod's weight
        for (const int finger : {2, 3}) {
            const Vec3 v = world.state({finger}).v_WB;
            world.set_velocity({finger}, {v.x(), 0, 0});
            world.apply({finger}, {finger == 2 ? press : -press, 0, 0}, Vec3::Zero());
        }
        world.step(kStep);
    }
    const Vec3 along = world.state({1}).X_WB.R * Vec3::UnitY();
    return std::atan2(-along.z(), along.y());
}

TEST(SoftFinger, HoldsARodByItsEndAndLetsItSwingWhenItEases) {
    // the moment of its weight about the pinch is 0.02 kg g 0.09 m = 17.7 mN m; two fingers of 12
    // mm carry 2 mu r N = 19.2 mN m per N at mu = 0.8, minus the part that carries the weight
    for (const contact::Solver solver :
         {contact::Solver::sequential_impulse, contact::Solver::stewart_trinkle,
          contact::Solver::staggered_projections, contact::Solver::newton}) {
        World firm = held_rod(solver, 0.012);
        EXPECT_LT(std::abs(turned_after(firm, 2, 0.3)), 0.002);
        World loose = held_rod(solver, 0.012);
        EXPECT_GT(turned_after(loose, 0.5, 0.3), 0.3);
        World hard = held_rod(solver, 0);
        EXPECT_GT(turned_after(hard, 2, 0.3), 0.3);
    }
}

}  // namespace
}  // namespace dihaptic::dynamics::solvers_test
