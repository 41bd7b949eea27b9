// The command `dihaptic-bench scale`: measures the cost of a tick as the table fills with blocks.
// docs/measures.md defines the figures.
#pragma once

#include <string>
#include <vector>

#include "measure/grasp.h"

namespace dihaptic::bench {

struct Cost {
    double median_us = 0;
    double p99_us = 0;
    double max_us = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("median_us", f.median_us, "us", "");
        v("p99_us", f.p99_us, "us", "");
        v("max_us", f.max_us, "us", "");
    }
};

struct ScaleFigures {
    int extra = 0;
    Cost awake;
    Cost asleep;
    double bullet_us = 0;  ///< median of bare Bullet steps of that world, without sleeping

    /// The bar: a tick may take this multiple of a bare step, plus this time.
    static constexpr double kMostTimes = 1.3;
    static constexpr double kMostMore = 10;  ///< [us]
    double most_us() const { return kMostTimes * bullet_us + kMostMore; }
    bool within_bar() const { return awake.median_us <= most_us(); }

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("extra", f.extra, "1", "more blocks on the table");
        v("awake", f.awake, "", "a tick with all of them awake");
        v("asleep", f.asleep, "", "a tick while they may sleep");
        v("bullet_us", f.bullet_us, "us", "median time of the bare step");
        v("most_us", f.most_us(), "us", "the bar");
        v("within_bar", f.within_bar(), "", "whether the median awake is within the bar");
    }
};

/// Measures the entire tick, including recording, over the script of `bench grasp`.
std::vector<ScaleFigures> bench_scale(const measure::BenchSetup& setup,
                                      const std::vector<int>& extras,
                                      const measure::Progress& progress);

}  // namespace dihaptic::bench
