// Two fingers close on a block and lift it by 5 cm, in a world that is stepped a thousand times a
// second.
#include <algorithm>
#include <array>
#include <cstdio>

#include "base/installed.h"
#include "dynamics/world.h"

using namespace dihaptic;

int main() {
    try {
        Diagnostics diagnostics;
        const scene::Scene scene =
            scene::read_scene(kept("scenes/block-on-table.yaml"), diagnostics);
        diagnostics.throw_if_errors();
        dynamics::World world(scene, dynamics::Settings{});
        const std::array<double, 2> side{-1, 1};  // of the thumb and of the index finger, along x
        std::array<dynamics::BodyIndex, 2> fingers;
        for (size_t i = 0; i < 2; ++i)
            fingers[i] = world.add_proxy(scene.fingers[i], {side[i] * 0.04, 0, 0.02});
        world.activate();
        const dynamics::BodyIndex block = world.find("block");

        const double h = 0.001;        // step [s]
        const double stiffness = 500;  // of the spring that pulls a finger to its target [N/m]
        const double damping = 0.5;    // [N*s/m]
        std::printf("time s  height mm  grip N\n");
        for (int tick = 0; tick <= 3000; ++tick) {
            const double time = tick * h;
            const double close = std::clamp(time, 0.0, 1.0);
            const double lift = std::clamp(time - 1, 0.0, 1.0);
            for (size_t i = 0; i < 2; ++i) {
                const dynamics::BodyState& finger = world.state(fingers[i]);
                const Vec3 target(side[i] * (0.04 - 0.022 * close), 0, 0.02 + 0.05 * lift);
                const Vec3 pull = stiffness * (target - finger.X_WB.p) - damping * finger.v_WB;
                world.apply(fingers[i], pull, Vec3::Zero());
            }
            if (world.step(h) != dynamics::StepStatus::ok) return 1;
            if (tick % 500 != 0) continue;
            double grip = 0;  // normal forces of the contacts of the thumb
            for (const contact::Contact& contact : world.contacts())
                if (contact.a == fingers[0] || contact.b == fingers[0])
                    grip += contact.normal_force;
            std::printf("%6.1f %10.2f %7.3f\n", time, world.state(block).X_WB.p.z() * 1e3, grip);
        }
        const bool lifted = world.state(block).X_WB.p.z() > 0.065;
        std::puts(lifted ? "The block is lifted." : "The block was lost.");
        return lifted ? 0 : 1;
    } catch (const Error& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 2;
    }
}
