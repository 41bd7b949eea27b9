// Solves contact problems with Siconos (INRIA), as a peer of our solvers, in builds with peers
// (docs/measures.md).
#pragma once

#include <string>
#include <vector>

#include "contact/problem.h"

namespace dihaptic::bench {

struct PeerAnswer {
    Eigen::VectorXd r;
    int iterations = 0;
    double us = 0;  ///< time of the solve without converting the problem [us]
};

/// Names of Siconos' solvers; empty in builds without peers.
std::vector<std::string> siconos_solvers();
/// Solves from zero impulses, to the tolerance of our solvers. Throws Error in builds without
/// peers.
PeerAnswer solve_by_siconos(const std::string& solver, const contact::DelassusProblem& problem);

}  // namespace dihaptic::bench
