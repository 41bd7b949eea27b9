// The command `dihaptic-bench chain`: measures the time of a step and its accuracy, for chains of
// links on hinges in each solver and in the peers. docs/measures.md defines the figures.
#pragma once

#include <string>
#include <vector>

#include "bench/simulator.h"
#include "measure/grasp.h"

namespace dihaptic::bench {

struct ChainFigures {
    std::string simulator;
    int links = 0;
    double step_us = 0;
    double off_mm = 0;
    double apart_mm = 0;
    double energy = 0;
    double energy_above = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("simulator", f.simulator, "", "");
        v("links", f.links, "1", "");
        v("step_us", f.step_us, "us", "median time of a step");
        v("off_mm", f.off_mm, "mm",
          "largest deviation of the last link from its equations of motion in the first second");
        v("apart_mm", f.apart_mm, "mm", "largest separation of links at a hinge in 10 s");
        v("energy", f.energy, "1",
          "mean energy of the last 2 s over that of the first 2 s, minus 1");
        v("energy_above", f.energy_above, "1", "largest energy over the initial energy, minus 1");
    }
};

/// Links of 60 x 10 x 10 mm and 20 g on hinges, which hang from the origin, stretched out at an
/// angle from the vertical. They are side by side, so that they do not meet.
scene::Scene chain(int links, double angle);
/// The position of the last link's centre according to the equations of motion, at each half
/// step of 1 ms, released from rest at that angle.
std::vector<Vec3> exact_ends(int links, double angle, double duration);
/// Energy of a link at a height, with a velocity, and an angular velocity in its own frame [J].
double energy_of_link(double height, const Vec3& v, const Vec3& w_B);
/// Energy of a chain at rest at that angle, relative to a chain that hangs straight down [J].
double energy_of_chain_at(int links, double angle);

/// Runs each simulator with chains of these numbers of links.
std::vector<ChainFigures> bench_chain(const std::vector<Simulator>& simulators,
                                      const std::vector<int>& links,
                                      const measure::Progress& progress);

}  // namespace dihaptic::bench
