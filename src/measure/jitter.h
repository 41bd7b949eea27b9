// `dihaptic bench jitter`: how punctual the real-time thread is, beside cyclictest. Definitions in
// docs/measures.md.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "measure/cyclictest.h"
#include "measure/grasp.h"

namespace dihaptic::measure {

/// [us]
struct Spread {
    double median = 0;
    double p99 = 0;
    double p999 = 0;
    double max = 0;
};

struct JitterFigures {
    double rate = 0;  ///< [Hz]
    int extra = 0;    ///< blocks on the table, awake
    double seconds = 0;
    int64_t ticks = 0;
    Spread lateness;
    Spread tick;
    int64_t overruns = 0;
    int64_t dropped = 0;  ///< frames that were not recorded
    bool held = false;    ///< the block, to the end
    Wakeups wakeups;
    std::string refused;  ///< of what real time takes; "" when nothing was
    Wakeups cyclictest;
    double pictures = 0;         ///< a second, of a view that draws beside both; 0: there is none
    int64_t quiet_overruns = 0;  ///< of as many ticks without that view
    std::string no_cyclictest;   ///< why it has no wake-ups

    double period() const { return 1e6 / rate; }          ///< [us]
    double slack() const { return period() - tick.p99; }  ///< [us]
    double p999_ratio() const;                            ///< NaN without cyclictest
    int64_t cyclictest_late() const { return cyclictest.later_than(slack()); }
};

/// Two fingers hold the block in the air, recording included, for `seconds` in turn with cyclictest
/// for as long; or until `stop`. `view`: one draws beside both as fast as it can, and in turn with
/// them the servo runs as long without. Throws Error when nothing can be drawn.
JitterFigures bench_jitter(const BenchSetup& setup, double seconds, bool view,
                           const std::atomic<bool>& stop, const Progress& progress);

std::string to_json(const JitterFigures& figures);
std::string to_table(const JitterFigures& figures);

/// Several runs: how a figure of one spreads over them, and the bar that it is held against.
struct JitterRuns {
    std::vector<JitterFigures> runs;

    /// Runs with no more overruns than cyclictest would have had.
    int within_bar() const;
};
std::string to_json(const JitterRuns& runs);
/// A row for each run, then what they have in common.
std::string to_table(const JitterRuns& runs);

}  // namespace dihaptic::measure
