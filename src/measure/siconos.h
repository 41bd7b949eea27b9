// Siconos (INRIA) beside our solvers, where this was built with peers (docs/measures.md).
#pragma once

#include <string>
#include <vector>

#include "contact/problem.h"

namespace dihaptic::measure {

struct PeerAnswer {
    Eigen::VectorXd r;
    int iterations = 0;
    double us = 0;  ///< of the solve alone; the problem was put into Siconos' form before
};

/// Names of its solvers; none where this was built without it.
std::vector<std::string> siconos_solvers();
/// Solves from zero impulses, to the tolerance of our solvers.
PeerAnswer solve_by_siconos(const std::string& solver, const contact::DelassusProblem& problem);

}  // namespace dihaptic::measure
