// The command `dihaptic-bench solvers`: measures the solvers' times on recorded contact problems.
// docs/measures.md defines the figures.
#pragma once

#include <string>
#include <vector>

#include "contact/solver_settings.h"
#include "measure/grasp.h"

namespace dihaptic::bench {

struct SolversBench {
    /// Solvers to measure in addition to Bullet's, which is always measured.
    std::vector<contact::Solver> solvers{
        contact::Solver::newton, contact::Solver::staggered_projections,
        contact::Solver::stewart_trinkle, contact::Solver::sequential_impulse};
    size_t most_problems = 400;  ///< maximum number of problems of each scene
    double budget = 0.7;         ///< time for one solver on one scene's problems [s]
};

/// One solver on the problems from one scene.
struct SolverCost {
    std::string solver;  ///< one of ours, or kBulletSolver
    std::string family;
    int contacts = 0;          ///< approximate number (ProblemGroup)
    double mean_contacts = 0;  ///< mean number in the problems solved
    double median_us = 0;
    double p99_us = 0;
    double ratio_median = 0;  ///< median ratio of its time to Bullet's, problem by problem
    int fallbacks = 0;        ///< number of problems solved by another method or by sweeps
    int missed = 0;           ///< number of problems whose fallback also missed the tolerance
    double residual_p99 = 0;  ///< natural map over 1 + |q|
    int solves = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("solver", f.solver, "", "one of ours, or Bullet's");
        v("family", f.family, "", "family of scenes");
        v("contacts", f.contacts, "1", "approximate number in the scene");
        v("mean_contacts", f.mean_contacts, "1", "in the problems solved");
        v("median_us", f.median_us, "us", "time of a solve from the previous tick's impulses");
        v("p99_us", f.p99_us, "us", "");
        v("ratio_median", f.ratio_median, "1", "ratio of time to Bullet's on the same problem");
        v("fallbacks", f.fallbacks, "1", "solves by another method");
        v("missed", f.missed, "1", "solves above 1e-8");
        v("residual_p99", f.residual_p99, "1", "natural map");
        v("solves", f.solves, "1", "");
    }
};

/// States of the contacts at the solution, which determine the problems' difficulty.
struct ProblemFigures {
    std::string family;
    int contacts = 0;
    double mean_contacts = 0;
    double sticking = 0, sliding = 0, open = 0;  ///< fractions of all contacts
    int problems = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("family", f.family, "", "family of scenes");
        v("contacts", f.contacts, "1", "approximate number in the scene");
        v("mean_contacts", f.mean_contacts, "1", "mean number in the problems");
        v("sticking", f.sticking, "1", "fraction of all contacts");
        v("sliding", f.sliding, "1", "fraction of all contacts");
        v("open", f.open, "1", "fraction of all contacts");
        v("problems", f.problems, "1", "");
    }
};

/// Exponent with which a solver's time grows with the number of contacts, from 8 to 200.
struct Growth {
    std::string solver;
    std::string family;
    double median = 0;
    double p99 = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("solver", f.solver, "", "");
        v("family", f.family, "", "family of scenes");
        v("median_exponent", f.median, "1", "");
        v("p99_exponent", f.p99, "1", "");
    }
};

struct SolversFigures {
    std::vector<ProblemFigures> problems;
    std::vector<SolverCost> costs;
    std::vector<Growth> growth;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("problems", f.problems, "", "problems, and the states of their contacts");
        v("solvers", f.costs, "", "one solve, compared with 50 iterations of Bullet's");
        v("growth", f.growth, "", "time grows as this power of the number of contacts");
    }
};

constexpr int kBulletIterations = 50;
constexpr const char* kBulletSolver = "bullet";

SolversFigures bench_solvers(const SolversBench& bench, const measure::Progress& progress);

}  // namespace dihaptic::bench
