// Tests that chains in `bench chain` hang together, ours with the stated accuracy.
#include "bench/chain.h"

#include <gtest/gtest.h>

namespace dihaptic::bench::chain_test {
namespace {

TEST(BenchChain, OursHoldsTogetherAndKeepsItsEnergy) {
    frame::DynamicsSettings settings;
    settings.solver = contact::Solver::newton;
    const auto rows = bench_chain({world_simulator(settings), bullet_simulator()}, {2, 5},
                                  [](const std::string&, double) {});
    ASSERT_EQ(rows.size(), 4u);
    for (const ChainFigures& row : rows) {
        EXPECT_GT(row.step_us, 0);
        if (row.simulator == "newton") {
            EXPECT_LT(row.apart_mm, 1e-3) << row.links;
            EXPECT_LT(std::abs(row.energy), 1e-3) << row.links;
            EXPECT_LT(row.energy_above, 1e-2) << row.links;
        } else {
            EXPECT_LT(row.apart_mm, 60 * row.links) << row.links;  // links are joined at all
        }
    }
}

TEST(BenchChain, OursHoldsFiftyLinks) {
    frame::DynamicsSettings settings;
    settings.solver = contact::Solver::newton;
    const auto rows =
        bench_chain({world_simulator(settings)}, {50}, [](const std::string&, double) {});
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_LT(rows[0].apart_mm, 1e-3);
    EXPECT_LT(std::abs(rows[0].energy), 1e-3);
    EXPECT_LT(rows[0].energy_above, 1e-2);
}

}  // namespace
}  // namespace dihaptic::bench::chain_test
