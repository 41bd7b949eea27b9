#include "bench/heap.h"

#include <gtest/gtest.h>

namespace dihaptic::bench::heap_test {
namespace {

TEST(HeapBench, AHeapBesideItDoesNotCostTheHandItsExactness) {
    measure::BenchSetup setup;
    setup.settings.coupling.stiffness = 1000;
    setup.hold_time = 1;
    const HeapFigures figures = measure_heap(setup, 20);
    EXPECT_LE(figures.held_residual, 1e-8);
    EXPECT_GT(figures.held_residual, 0);
    EXPECT_LE(figures.hf_force_n, 0.02);  // like a calm grasp
    EXPECT_GT(figures.ended, 500);
    EXPECT_LE(figures.ended, 1000);
    EXPECT_GT(figures.tick_median_us, 0);
    EXPECT_EQ(figures.unbalanced, 0);
    EXPECT_GT(figures.overlap_mm, 0);
    EXPECT_LE(figures.overlap_mm, 0.2);
}

}  // namespace
}  // namespace dihaptic::bench::heap_test
