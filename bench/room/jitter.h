// The command `dihaptic-bench jitter`: measures the punctuality of the real-time thread, in
// comparison with cyclictest. docs/measures.md defines the figures.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/cyclictest.h"
#include "display/sound.h"
#include "measure/grasp.h"

namespace dihaptic::bench {

/// Quantiles of a time [us].
struct Spread {
    double median = 0;
    double p99 = 0;
    double p999 = 0;
    double max = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("median", f.median, "", "[us]");
        v("p99", f.p99, "", "[us]");
        v("p999", f.p999, "", "[us]");
        v("max", f.max, "", "[us]");
    }
};

struct JitterFigures {
    double rate = 0;  ///< [Hz]
    int extra = 0;    ///< number of blocks on the table, awake
    double seconds = 0;
    int64_t ticks = 0;
    Spread lateness;
    Spread tick;
    int64_t overruns = 0;
    int64_t dropped = 0;  ///< number of unrecorded frames
    bool held = false;    ///< whether the block was held to the end
    Wakeups wakeups;
    std::string refused;  ///< real-time permissions refused by the system; "" if none
    Wakeups cyclictest;
    double pictures = 0;         ///< pictures per second of the additional view; 0: no view
    int64_t sounds = 0;          ///< number heard during the servo's turns
    int64_t quiet_overruns = 0;  ///< overruns in the same number of ticks without view and sounds
    Spread quiet_lateness;       ///< the same
    std::string no_cyclictest;   ///< reason why cyclictest has no wake-ups

    double period() const { return 1e6 / rate; }          ///< [us]
    double slack() const { return period() - tick.p99; }  ///< [us]
    double tick_p99_share() const { return tick.p99 / period(); }
    bool disturbed() const { return pictures > 0 || sounds > 0; }
    double p999_ratio() const;  ///< NaN without cyclictest
    int64_t cyclictest_late() const { return cyclictest.later_than(slack()); }
    Spread cyclictest_spread() const;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        const auto given = [](bool is_given, const auto& value) {
            return is_given ? std::optional(value) : std::nullopt;
        };
        const bool peer = f.cyclictest.count() > 0;
        const bool viewed = f.pictures > 0;
        v("rate_hz", f.rate, "Hz", "ticks per second");
        v("extra", f.extra, "1", "blocks on the table, awake");
        v("seconds", f.seconds, "", "duration of the servo's turns");
        v("lateness_us", f.lateness, "us", "lateness of a tick's start");
        v("tick_us", f.tick, "us", "duration of ticks, including recording");
        v("ticks", f.ticks, "1", "");
        v("overruns", f.overruns, "1", "ticks that ended after the next deadline");
        v("dropped", f.dropped, "1", "unrecorded frames");
        v("held", f.held, "", "whether the block was held to the end");
        v("cyclictest_us", given(peer, f.cyclictest_spread()), "us",
          "lateness of cyclictest's wake-ups");
        v("lateness_p999_ratio", f.p999_ratio(), "1", "our p99.9 over cyclictest's");
        v("tick_p99_share", f.tick_p99_share(), "1", "fraction of the period");
        v("slack_us", f.slack(), "us", "period minus a tick's p99");
        v("cyclictest_late", given(peer, f.cyclictest_late()), "1",
          "cyclictest's wake-ups later than the slack");
        v("view_hz", given(viewed, f.pictures), "Hz", "pictures drawn meanwhile");
        v("sounds", given(f.sounds > 0, f.sounds), "1", "sounds heard meanwhile");
        v("overruns_without", given(f.disturbed(), f.quiet_overruns), "1",
          "in the same number of ticks without view and sounds");
        v("lateness_without_us", given(f.disturbed(), f.quiet_lateness), "us", "the same");
        v("refused", given(!f.refused.empty(), f.refused), "", "permissions that Linux refused");
    }
};

/// The additional load during the servo's run.
struct Beside {
    bool view = false;  ///< whether a view draws as fast as possible
    /// Output for a tone that starts twenty times per second.
    display::SoundTo sound = display::SoundTo::nowhere;

    bool sounds() const { return sound != display::SoundTo::nowhere; }
    bool anything() const { return view || sounds(); }
};

/// Two fingers hold the block in the air, with a recording, for `seconds`, alternating with
/// cyclictest for the same time, or until `stop`. With an additional load, the servo also runs
/// without it in turn, for the same time. Throws Error if drawing or playing is impossible.
JitterFigures bench_jitter(const measure::BenchSetup& setup, double seconds, const Beside& beside,
                           const std::atomic<bool>& stop, const measure::Progress& progress);

std::string to_text(const JitterFigures& figures);

/// Median, minimum and maximum of a figure over several runs.
struct OfRuns {
    double median = 0;
    double least = 0;
    double most = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("median", f.median, "", "");
        v("least", f.least, "", "");
        v("most", f.most, "", "");
    }
};

/// Several runs, to show the variation of figures between runs and the number of runs that meet the
/// bar.
struct JitterRuns {
    std::vector<JitterFigures> runs;

    /// Number of runs with no more overruns than for cyclictest.
    int within_bar() const;
    /// For a figure: a member of JitterFigures, or the result of one of its functions.
    OfRuns over(const auto& figure) const {
        std::vector<double> values;
        for (const JitterFigures& f : runs)
            values.push_back(static_cast<double>(std::invoke(figure, f)));
        return sorted(std::move(values));
    }

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("runs", f.runs, "", "");
        v("lateness_p999_ratio", f.over(&JitterFigures::p999_ratio), "1", "");
        v("overruns", f.over(&JitterFigures::overruns), "1", "");
        v("cyclictest_late", f.over(&JitterFigures::cyclictest_late), "1", "");
        v("tick_p99_share", f.over(&JitterFigures::tick_p99_share), "1", "");
        v("within_bar", f.within_bar(), "1", "runs with no more overruns than cyclictest_late");
    }

  private:
    static OfRuns sorted(std::vector<double> values);
};
/// A row for each run, then figures over all of them.
std::string to_text(const JitterRuns& runs);

}  // namespace dihaptic::bench
