#include "bench/simulator.h"

#include "dynamics/world.h"

namespace dihaptic::bench {

Simulator world_simulator(frame::DynamicsSettings settings) {
    settings.sleeping = false;
    return {std::string(enum_name(settings.solver)),
            [settings](const Trial& trial, int steps, const Watch& watch) {
                dynamics::World world(trial.scene, settings);
                world.activate();
                std::vector<Pose> X_WB(trial.scene.bodies.size());
                for (int i = 0; i < steps; ++i) {
                    trial.push(i, [&](const Trial::Push& push) {
                        world.apply({static_cast<int>(push.body)}, push.force_W, Vec3::Zero());
                    });
                    world.step(kStep);
                    for (size_t b = 0; b < X_WB.size(); ++b) X_WB[b] = world.states()[b].X_WB;
                    if (!watch(X_WB)) return;
                }
            }};
}

std::vector<Simulator> peer_simulators() {
    std::vector<Simulator> out{bullet_simulator()};
    for (Simulator& mujoco : mujoco_simulators()) out.push_back(std::move(mujoco));
    return out;
}

std::vector<Simulator> jointed_peers() {
    std::vector<Simulator> out{bullet_simulator()};
    for (const auto& peers : {mujoco_jointed_simulators(), ode_simulators(), simbody_simulators()})
        out.insert(out.end(), peers.begin(), peers.end());
    return out;
}

}  // namespace dihaptic::bench
