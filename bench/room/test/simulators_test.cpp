// Tests that our simulator and the peers in this build treat scenes, forces and poses alike.
#include <gtest/gtest.h>

#include "bench/friction.h"

namespace dihaptic::bench::simulators_test {
namespace {

std::vector<Simulator> all() {
    std::vector<Simulator> out = peer_simulators();
    out.push_back(world_simulator({}));
    return out;
}

Pose last_pose(const Simulator& simulator, const Trial& trial, int steps, size_t body) {
    Pose out;
    int seen = 0;
    simulator.run(trial, steps, [&](std::span<const Pose> X_WB) {
        out = X_WB[body];
        ++seen;
        return true;
    });
    EXPECT_EQ(seen, steps);
    return out;
}

TEST(Simulators, LetStonesFallByTheirOwnFrames) {
    // a stone's frame is neither at its centre of mass nor along its principal axes
    Trial trial;
    trial.scene = arch_scene(9);
    trial.scene.bodies = {trial.scene.bodies[3]};
    trial.scene.bodies[0].position = {0.1, 0.2, 3};
    trial.scene.bodies[0].rotation = {0.3, 0.2, 0.1};
    const double mass = scene::mass(trial.scene.bodies[0]);
    trial.pushes = {{0, {2 * mass, 0, 0}}};
    const int n = 300;
    // semi-implicit Euler: a h^2 n (n + 1) / 2
    const double covered = kStep * kStep * n * (n + 1) / 2;
    for (const Simulator& simulator : all()) {
        SCOPED_TRACE(simulator.name);
        const Pose X = last_pose(simulator, trial, n, 0);
        EXPECT_NEAR(X.p.x(), 0.1 + 2 * covered, 1e-9);
        EXPECT_NEAR(X.p.y(), 0.2, 1e-9);
        EXPECT_NEAR(X.p.z(), 3 - 9.81 * covered, 1e-9);
        EXPECT_NEAR(angle_between(X.R, trial.scene.bodies[0].pose().R), 0, 1e-7);
    }
}

TEST(Simulators, HoldABlockThatIsPinchedHardEnough) {
    for (const Simulator& simulator : all()) {
        // by default MuJoCo's contacts are so soft that the pads pass through
        if (simulator.name == "mujoco") continue;
        SCOPED_TRACE(simulator.name);
        Trial trial = pinch_trial();
        EXPECT_LT(std::abs(last_pose(simulator, trial, 500, 0).p.z()), 0.002);
        for (Trial::Push& push : trial.pushes) push.force_W *= 0.15;  // needs 0.18
        EXPECT_LT(last_pose(simulator, trial, 500, 0).p.z(), -0.01);
    }
}

TEST(Simulators, EndWhenTheWatcherHasSeenEnough) {
    for (const Simulator& simulator : all()) {
        int seen = 0;
        simulator.run(pinch_trial(), 100, [&](std::span<const Pose>) { return ++seen < 7; });
        EXPECT_EQ(seen, 7) << simulator.name;
    }
}

}  // namespace
}  // namespace dihaptic::bench::simulators_test
