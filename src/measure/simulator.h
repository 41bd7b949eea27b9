// Whatever moves the bodies of a scene, in steps of 1 ms: our solvers, and peers beside them.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/settings.h"
#include "scene/scene.h"

namespace dihaptic::measure {

constexpr double kStep = 1e-3;  // [s]

/// A scene, and the forces that act in it all the time.
struct Trial {
    struct Push {
        size_t body = 0;
        Vec3 force_W = Vec3::Zero();  ///< at the centre of mass [N]
    };
    scene::Scene scene;
    std::vector<Push> pushes;
};

/// Sees the poses X_WB of all bodies after each step; false ends the run. Bodies whose simulator
/// gave up are infinitely far away.
using Watch = std::function<bool(std::span<const Pose> X_WB)>;

struct Simulator {
    std::string name;
    std::function<void(const Trial& trial, int steps, const Watch& watch)> run;
    /// What blocks slide on: a box, or a plane if contacts with that are the better ones.
    scene::ShapeKind slope = scene::ShapeKind::box;
};

/// Our World. Nothing sleeps.
Simulator world_simulator(dynamics::Settings settings);

/// Bullet's own world with all its default settings: 10 iterations, one direction of friction.
/// Nothing sleeps.
Simulator bullet_simulator();

/// MuJoCo with elliptic cones, by settings; none where this was built without peers.
std::vector<Simulator> mujoco_simulators();

/// All that stand beside ours.
std::vector<Simulator> peer_simulators();

}  // namespace dihaptic::measure
