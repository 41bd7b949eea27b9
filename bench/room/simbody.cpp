// Runs bodies on hinges in Simbody, as a peer of our own solvers.
#include "bench/simulator.h"

#ifdef DIHAPTIC_PEERS
#include "bench/hinges.h"
#include "bench/simbody_model.h"
#include "scene/solid.h"
#endif

namespace dihaptic::bench {

#ifdef DIHAPTIC_PEERS

namespace {

std::vector<simbody::Link> links_of(const scene::Scene& scene) {
    std::vector<simbody::Link> out;
    std::vector<int> link_of(scene.bodies.size(), -1);
    for (const Hinge& hinge : hinges_of(scene)) {
        const scene::Body& body = scene.bodies[hinge.body];
        const scene::Solid solid = scene::solid_of(body.shape, scene::mass(body));
        const Pose X_WJ = frame_of(hinge);
        const Pose X_WP = hinge.parent ? scene.bodies[*hinge.parent].pose() : Pose{};
        simbody::Link link;
        link.parent = hinge.parent ? link_of[*hinge.parent] : -1;
        link.mass = solid.mass;
        // the benches' bodies are boxes, with the solid's axes
        link.inertia = solid.inertia;
        link.X_PJ = X_WP.inverse() * X_WJ;
        link.X_BJ = body.pose().inverse() * X_WJ;
        link_of[hinge.body] = static_cast<int>(out.size());
        out.push_back(link);
    }
    return out;
}

Simulator simulator(const std::string& name, simbody::Steps kind) {
    return {name, [kind](const Trial& trial, int steps, const Watch& watch) {
                if (!trial.pushes.empty())
                    throw Error("Simbody gets no external forces", "Use chains.");
                simbody::Model model(links_of(trial.scene), trial.scene.gravity, kind);
                std::vector<Pose> X_WB(trial.scene.bodies.size());
                for (int i = 1; i <= steps; ++i) {
                    model.step_to(i * kStep, X_WB);
                    if (!watch(X_WB)) return;
                }
            }};
}

}  // namespace

std::vector<Simulator> simbody_simulators() {
    return {simulator("simbody", simbody::Steps::chosen),
            simulator("simbody_euler", simbody::Steps::of_1_ms)};
}

#else

std::vector<Simulator> simbody_simulators() {
    return {};
}

#endif

}  // namespace dihaptic::bench
