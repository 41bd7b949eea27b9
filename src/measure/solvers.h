// The command `dihaptic bench solvers`: measures the solvers' times on recorded contact problems.
// docs/measures.md defines the figures.
#pragma once

#include <string>
#include <vector>

#include "contact/solver_settings.h"
#include "measure/grasp.h"

namespace dihaptic::measure {

struct SolversBench {
    /// Solvers to measure beside Bullet's, which is always measured.
    std::vector<contact::Solver> solvers{contact::Solver::newton,
                                         contact::Solver::staggered_projections,
                                         contact::Solver::stewart_trinkle};
    size_t most_problems = 400;  ///< most problems of each scene
    double budget = 0.7;         ///< time for one solver on one scene's problems [s]
};

/// One solver on the problems of one scene.
struct SolverCost {
    contact::Solver solver{};
    std::string family;
    int contacts = 0;          ///< approximate number (ProblemGroup)
    double mean_contacts = 0;  ///< mean number in the problems solved
    double median_us = 0;
    double p99_us = 0;
    double ratio_median = 0;  ///< median of its times over Bullet's, problem by problem
    int fallbacks = 0;        ///< number of problems that another method, or sweeps, solved
    int missed = 0;           ///< number in which even the fallback stayed above tolerance
    double residual_p99 = 0;  ///< natural map over 1 + |q|
    int solves = 0;
};

/// States of the contacts at the solution, which decide how hard the problems are.
struct ProblemFigures {
    std::string family;
    int contacts = 0;
    double mean_contacts = 0;
    double sticking = 0, sliding = 0, open = 0;  ///< shares of all contacts
    int problems = 0;
};

/// Power of the number of contacts, from 8 to 200, with which a solver's time grows.
struct Growth {
    contact::Solver solver{};
    std::string family;
    double median = 0;
    double p99 = 0;
};

struct SolversFigures {
    std::vector<ProblemFigures> problems;
    std::vector<SolverCost> costs;
    std::vector<Growth> growth;
};

constexpr int kBulletIterations = 50;

SolversFigures bench_solvers(const SolversBench& bench, const Progress& progress);

std::string to_json(const SolversFigures& figures);
std::string to_table(const SolversFigures& figures);

}  // namespace dihaptic::measure
