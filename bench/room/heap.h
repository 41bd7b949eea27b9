// The command `dihaptic-bench heap`: measures the effect of a heap next to a held block on the
// hand's accuracy and on the time of a tick. docs/measures.md defines the figures.
#pragma once

#include <vector>

#include "measure/grasp.h"

namespace dihaptic::bench {

struct HeapFigures {
    int loose = 0;
    double held_residual = 0;
    double tick_median_us = 0, tick_p99_us = 0, tick_max_us = 0;
    int ended = 0;
    int unbalanced = 0;
    double overlap_mm = 0;
    double hf_force_n = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("loose", f.loose, "1", "boxes and balls in the heap");
        v("held_residual", f.held_residual, "1", "largest in the held block's island");
        v("tick_median_us", f.tick_median_us, "us", "entire tick, including recording");
        v("tick_p99_us", f.tick_p99_us, "us", "");
        v("tick_max_us", f.tick_max_us, "us", "");
        v("ended", f.ended, "1", "ticks in which the limit of work ended an island");
        v("unbalanced", f.unbalanced, "1", "ticks in which the books did not balance");
        v("overlap_mm", f.overlap_mm, "mm", "largest depth of two bodies in each other");
        v("hf_force_n", f.hf_force_n, "N", "handle force above 5 Hz, RMS");
    }
};

/// Holds the block in the air for 5 s next to a stirred heap.
HeapFigures measure_heap(const measure::BenchSetup& setup, int loose);
std::vector<HeapFigures> bench_heap(const measure::BenchSetup& setup, const std::vector<int>& loose,
                                    const measure::Progress& progress);

}  // namespace dihaptic::bench
