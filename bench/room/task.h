// The command `dihaptic-bench task`: measures the cost of a task in a tick. docs/measures.md
// defines the figures.
#pragma once

#include "bench/scale.h"

namespace dihaptic::bench {

struct TaskFigures {
    int states = 0;  ///< number of states in the trial
    int loads = 0;   ///< number of loads in each tick of these states
    Cost plain;
    Cost task;
    double more_us = 0;         ///< median difference of the two medians, over the pairs of runs
    double expressions_us = 0;  ///< time of 20 expressions

    /// The acceptance limits.
    static constexpr double kMostMore = 5;         ///< [us]
    static constexpr double kMostExpressions = 2;  ///< [us]
    bool within_bars() const { return more_us <= kMostMore && expressions_us <= kMostExpressions; }

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("states", f.states, "1", "states in the trial");
        v("loads", f.loads, "1", "simultaneous loads");
        v("plain", f.plain, "", "a tick of a grasp");
        v("task", f.task, "", "a tick of the same grasp with the task");
        v("more_us", f.more_us, "us", "increase of the median by the task");
        v("expressions_us", f.expressions_us, "us", "20 expressions, including their quantities");
        v("within_bars", f.within_bars(), "", "5 and 2 us");
    }
};

/// Measures the entire tick, including recording, over the script of `bench grasp`: `pairs` times
/// without and with a task of 20 states and 10 loads.
TaskFigures bench_task(const measure::BenchSetup& setup, int pairs,
                       const measure::Progress& progress);

}  // namespace dihaptic::bench
