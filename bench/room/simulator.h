// A common interface to simulators that move the bodies of a scene in steps of 1 ms: our solvers,
// and peers for comparison.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "frame/dynamics_settings.h"
#include "scene/scene.h"

namespace dihaptic::bench {

constexpr double kStep = 1e-3;  // [s]

/// A scene, and forces in it; each acts from a given step on, and is constant.
struct Trial {
    struct Push {
        size_t body = 0;
        Vec3 force_W = Vec3::Zero();  ///< at the centre of mass [N]
        int from = 0;                 ///< the first step with this force
    };
    scene::Scene scene;
    std::vector<Push> pushes;

    /// Calls apply(push) for each force in a step, of which the first is 0.
    template <class Apply>
    void push(int step, const Apply& apply) const {
        for (const Push& one : pushes) {
            if (step >= one.from) apply(one);
        }
    }
};

/// Gets the poses X_WB of all bodies after each step; returns false to end the run. If a
/// simulator gives up, its bodies are infinitely far away.
using Watch = std::function<bool(std::span<const Pose> X_WB)>;

struct Simulator {
    std::string name;
    std::function<void(const Trial& trial, int steps, const Watch& watch)> run;
    /// Shape on which blocks slide: a box, or a plane if its contacts are better.
    scene::ShapeKind slope = scene::ShapeKind::box;
};

/// Our World, without sleeping.
Simulator world_simulator(frame::DynamicsSettings settings);

/// Bullet's own world with all its default settings: 10 iterations, one direction of friction.
/// No sleeping.
Simulator bullet_simulator();

/// MuJoCo with elliptic cones, one simulator per choice of settings; empty in builds without peers.
std::vector<Simulator> mujoco_simulators();

/// All simulators for comparison with ours on touching bodies.
std::vector<Simulator> peer_simulators();

/// MuJoCo with its integrators for joints; empty in builds without peers, like the
/// next two.
std::vector<Simulator> mujoco_jointed_simulators();

/// ODE, with its exact and its iterative solver. Only for bodies on hinges that do not
/// touch.
std::vector<Simulator> ode_simulators();

/// Simbody, whose coordinates are joint angles, with fixed steps and with steps that it
/// chooses. Only for bodies on hinges.
std::vector<Simulator> simbody_simulators();

/// All simulators for comparison with ours on bodies that hang on hinges.
std::vector<Simulator> jointed_peers();

}  // namespace dihaptic::bench
