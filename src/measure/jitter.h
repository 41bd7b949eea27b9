// The command `dihaptic bench jitter`: measures how punctual the real-time thread is, beside
// cyclictest. docs/measures.md defines the figures.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "measure/cyclictest.h"
#include "measure/grasp.h"

namespace dihaptic::measure {

/// Quantiles of a time [us].
struct Spread {
    double median = 0;
    double p99 = 0;
    double p999 = 0;
    double max = 0;
};

struct JitterFigures {
    double rate = 0;  ///< [Hz]
    int extra = 0;    ///< number of blocks on the table, awake
    double seconds = 0;
    int64_t ticks = 0;
    Spread lateness;
    Spread tick;
    int64_t overruns = 0;
    int64_t dropped = 0;  ///< number of frames that were not recorded
    bool held = false;    ///< the block was held to the end
    Wakeups wakeups;
    std::string refused;  ///< what the system refused of real time; "" if nothing
    Wakeups cyclictest;
    double pictures = 0;  ///< pictures per second of the view that draws beside both; 0: no view
    int64_t quiet_overruns = 0;  ///< overruns in as many ticks without that view
    std::string no_cyclictest;   ///< why cyclictest has no wake-ups

    double period() const { return 1e6 / rate; }          ///< [us]
    double slack() const { return period() - tick.p99; }  ///< [us]
    double p999_ratio() const;                            ///< NaN without cyclictest
    int64_t cyclictest_late() const { return cyclictest.later_than(slack()); }
};

/// Two fingers hold the block in the air, and are recorded, for `seconds`, in turn with cyclictest
/// for the same time; or until `stop`. With `view`, a view draws beside both as fast as it can, and
/// the servo also takes turns without it, for the same time. Throws Error when nothing can be
/// drawn.
JitterFigures bench_jitter(const BenchSetup& setup, double seconds, bool view,
                           const std::atomic<bool>& stop, const Progress& progress);

std::string to_json(const JitterFigures& figures);
std::string to_table(const JitterFigures& figures);

/// Several runs, to show how figures vary between runs and how many runs meet the bar.
struct JitterRuns {
    std::vector<JitterFigures> runs;

    /// Number of runs with no more overruns than cyclictest would have had.
    int within_bar() const;
};
std::string to_json(const JitterRuns& runs);
/// A row for each run, then figures over all of them.
std::string to_table(const JitterRuns& runs);

}  // namespace dihaptic::measure
