// The command `dihaptic bench scale`: measures the cost of a tick as the table fills with blocks.
// docs/measures.md defines the figures.
#pragma once

#include <string>
#include <vector>

#include "measure/grasp.h"

namespace dihaptic::measure {

struct Cost {
    double median_us = 0;
    double p99_us = 0;
    double max_us = 0;
};

struct ScaleFigures {
    int extra = 0;
    Cost awake;
    Cost asleep;
    double bullet_us = 0;  ///< median of bare Bullet steps of that world, with nothing asleep

    /// The bar: a tick may take this many times a bare step, and this much more.
    static constexpr double kMostTimes = 1.3;
    static constexpr double kMostMore = 10;  ///< [us]
    double most_us() const { return kMostTimes * bullet_us + kMostMore; }
    bool within_bar() const { return awake.median_us <= most_us(); }
};

/// Measures the whole tick, recording included, over the script of `bench grasp`.
std::vector<ScaleFigures> bench_scale(const BenchSetup& setup, const std::vector<int>& extras,
                                      const Progress& progress);

std::string to_json(const std::vector<ScaleFigures>& figures);
std::string to_table(const std::vector<ScaleFigures>& figures);

}  // namespace dihaptic::measure
