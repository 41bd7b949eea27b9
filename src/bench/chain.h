// The command `dihaptic-bench chain`: chains of links on hinges in each solver and in the peers,
// what a step costs and how exact it is. docs/measures.md defines the figures.
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
    double apart_mm = 0;
    double energy = 0;
    double energy_above = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("simulator", f.simulator, "", "");
        v("links", f.links, "1", "");
        v("step_us", f.step_us, "us", "median of a step");
        v("apart_mm", f.apart_mm, "mm", "most that links came apart at a hinge in 10 s");
        v("energy", f.energy, "1",
          "mean energy of the last 2 s over that of the first 2 s, less 1");
        v("energy_above", f.energy_above, "1", "most energy over that of the start, less 1");
    }
};

/// Each of the simulators with chains of so many links.
std::vector<ChainFigures> bench_chain(const std::vector<Simulator>& simulators,
                                      const std::vector<int>& links,
                                      const measure::Progress& progress);

}  // namespace dihaptic::bench
