// The command `dihaptic-bench task`: measures what a task costs in a tick. docs/measures.md defines
// the figures.
#pragma once

#include "bench/scale.h"

namespace dihaptic::bench {

struct TaskFigures {
    int states = 0;  ///< that the trial went through
    int loads = 0;   ///< that acted in each tick of them
    Cost plain;
    Cost task;
    double more_us = 0;         ///< median difference of the two medians, over the pairs of runs
    double expressions_us = 0;  ///< of 20 expressions

    /// The acceptance limits.
    static constexpr double kMostMore = 5;         ///< [us]
    static constexpr double kMostExpressions = 2;  ///< [us]
    bool within_bars() const { return more_us <= kMostMore && expressions_us <= kMostExpressions; }

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("states", f.states, "1", "that the trial went through");
        v("loads", f.loads, "1", "that acted at once");
        v("plain", f.plain, "", "a tick of a grasp");
        v("task", f.task, "", "a tick of the same grasp with the task");
        v("more_us", f.more_us, "us", "what the task adds to the median");
        v("expressions_us", f.expressions_us, "us", "20 expressions, with what they name");
        v("within_bars", f.within_bars(), "", "5 and 2 us");
    }
};

/// Measures the whole tick, recording included, over the script of `bench grasp`: `pairs` times
/// without and with a task of 20 states and 10 loads.
TaskFigures bench_task(const measure::BenchSetup& setup, int pairs,
                       const measure::Progress& progress);

}  // namespace dihaptic::bench
