// The command `dihaptic-bench mechanics`: measures joints, springs, bounces and soft surfaces
// against closed forms and independent integrations. docs/measures.md defines the figures.
#pragma once

#include <string>

#include "frame/dynamics_settings.h"
#include "measure/grasp.h"

namespace dihaptic::bench {

struct MechanicsFigures {
    std::string solver;
    double pendulum_period = 0;
    double pendulum_period_170 = 0;
    double pendulum_drift_mm = 0;
    double double_pendulum_mm = 0;
    double double_pendulum_order = 0;
    double cart_pendulum_mm = 0;
    double spring_deflection = 0;
    double spring_hz = 0;
    double spring_form = 0;
    double four_bar_mm = 0;
    double door_force_growth = 0;
    double bounce = 0;
    double bounce_bias = 0;
    double soft_k = 0;
    double energy = 0;
    double energy_above = 0;
    double whip_energy = 0;
    double whip_energy_above = 0;
    double reaction = 0;
    double lattice = 0;
    double calm_k_rigid = 0;
    double calm_k_hinge = 0;
    double calm_k_slider = 0;
    double calm_k_spring = 0;
    double tick_us = 0;
    double tick_six_us = 0;

    /// Whether every figure with an acceptance limit meets it.
    bool within_bars() const;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("solver", f.solver, "", "");
        v("pendulum_period", f.pendulum_period, "1", "relative error up to 90 degrees; 1e-4");
        v("pendulum_period_170", f.pendulum_period_170, "1",
          "relative error up to 170 degrees; 1e-3");
        v("pendulum_drift_mm", f.pendulum_drift_mm, "mm", "drift of the hinge in 60 s; 0.001");
        v("double_pendulum_mm", f.double_pendulum_mm, "mm", "in 2 s, from its equations; 1");
        v("double_pendulum_order", f.double_pendulum_order, "1", "from the error at half the step");
        v("cart_pendulum_mm", f.cart_pendulum_mm, "mm", "in 5 s, from its equations; 0.5");
        v("spring_deflection", f.spring_deflection, "1", "10 to 100 000 N/m, relative; 1e-6");
        v("spring_hz", f.spring_hz, "1", "frequency up to 15 Hz, relative; 1e-3");
        v("spring_form", f.spring_form, "1", "up to 100 Hz, from the closed form; 1e-3");
        v("four_bar_mm", f.four_bar_mm, "mm", "path of the coupler of a crank and rocker; 0.01");
        v("door_force_growth", f.door_force_growth, "1",
          "on three hinges: largest force in the last 5 s over that in the first 5 s");
        v("bounce", f.bounce, "1", "largest relative error of a height; 1e-2");
        v("bounce_bias", f.bounce_bias, "1", "mean of this error over start heights");
        v("soft_k", f.soft_k, "1", "felt stiffness of 50 to 5000 N/m, relative; 5e-3");
        v("energy", f.energy, "1", "ten links in 60 s, from 45 degrees: change of the mean; 1e-3");
        v("energy_above", f.energy_above, "1", "largest excess over the initial energy; 1e-2");
        v("whip_energy", f.whip_energy, "1",
          "the same from the horizontal, with the crack of a whip");
        v("whip_energy_above", f.whip_energy_above, "1",
          "largest excess over the initial energy, likewise");
        v("reaction", f.reaction, "1", "force in a loaded hinge, relative; 1e-6");
        v("lattice", f.lattice, "1", "a cantilever of ten blocks, from beam theory; 3e-2");
        v("calm_k_rigid", f.calm_k_rigid, "N/m", "highest stiffness that holds a block calmly");
        v("calm_k_hinge", f.calm_k_hinge, "N/m", "with a turning part on it; not lower");
        v("calm_k_slider", f.calm_k_slider, "N/m", "with a sliding part on it; not lower");
        v("calm_k_spring", f.calm_k_spring, "N/m", "with a part on a spring; not lower");
        v("tick_us", f.tick_us, "us", "p99 of a tick with the block held");
        v("tick_six_us", f.tick_six_us, "us", "the same with six joints on it; 10 us more");
        v("within_bars", f.within_bars(), "", "all figures but those of ticks meet their limits");
    }
};

/// All figures of one solver, at 1 kHz.
MechanicsFigures bench_mechanics(contact::Solver solver, const measure::Progress& progress);

}  // namespace dihaptic::bench
