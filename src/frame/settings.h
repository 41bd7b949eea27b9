// All settings that can be given in the scene, the rig, the experiment and on the command line. The
// later source takes precedence, except for `safety`, which belongs to the rig and can only be made
// stricter by the other sources (session/safety_limits.h).
#pragma once

#include "frame/dynamics_settings.h"
#include "frame/haptics_settings.h"

namespace dihaptic::frame {

struct Settings {
    double rate = 1000;           ///< tick rate [Hz]
    int real_time_priority = 80;  ///< under SCHED_FIFO, above the kernel's interrupt threads (50)
    DynamicsSettings dynamics;
    ProxySettings proxy;
    CouplingSettings coupling;
    SafetySettings safety;

    template <class Visitor>
    void visit(Visitor& v) {
        v("rate", rate,
          Field::of(Quantity::frequency).at_least(100).at_most(10000).says("Ticks per second."));
        v("real_time_priority", real_time_priority,
          Field::number().at_least(1).at_most(95).says(
              "Priority of the servo's thread on the real clock (SCHED_FIFO)."));
        v("dynamics", dynamics, says("How the world is stepped."));
        v("proxy", proxy, says("How fingers are represented in the world."));
        v("coupling", coupling, says("How a handle and its proxy pull at each other."));
        v("safety", safety,
          says(
              "Limits on every force, which scene, experiment and command line can only tighten."));
    }

    double tick() const { return 1 / rate; }                 ///< [s]
    double step() const { return tick() * dynamics.every; }  ///< time step of the world [s]
};

}  // namespace dihaptic::frame
