// Runs the solvers' bench on all its scenes, with a few problems from each.
#include <gtest/gtest.h>

#include <cmath>

#include "base/number.h"
#include "bench/solver_problems.h"
#include "bench/solvers.h"

namespace dihaptic::bench {
namespace {

TEST(BenchSolvers, SolvesGraspsStacksAndWallsWithoutAMiss) {
    SolversBench bench;
    bench.most_problems = 6;
    bench.budget = 0.05;
    const SolversFigures figures = bench_solvers(bench, {});
    for (const SolverCost& c : figures.costs) {
        SCOPED_TRACE(c.family + " " + number_text(c.contacts) + ", " + c.solver);
        // heaps that jam as they settle sometimes miss every solver's tolerance; the bench counts
        // them
        if (c.family != "pile") {
            EXPECT_EQ(c.missed, 0);
        }
        EXPECT_GT(c.solves, 0);
        EXPECT_GT(c.median_us, 0);
        EXPECT_NEAR(c.mean_contacts / c.contacts, 1, kContactsWithin);
    }
}

}  // namespace
}  // namespace dihaptic::bench
