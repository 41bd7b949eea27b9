// The command `dihaptic-bench jitter`: measures how punctual the real-time thread is, in comparison
// with cyclictest. docs/measures.md defines the figures.
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
    int64_t dropped = 0;  ///< number of frames that were not recorded
    bool held = false;    ///< the block was held to the end
    Wakeups wakeups;
    std::string refused;  ///< the real-time rights that the system refused; "" if none
    Wakeups cyclictest;
    double pictures = 0;  ///< pictures per second of the view that draws beside both; 0: no view
    int64_t sounds = 0;   ///< that were heard beside the servo
    int64_t quiet_overruns = 0;  ///< overruns in as many ticks without that view and these sounds
    Spread quiet_lateness;       ///< the same
    std::string no_cyclictest;   ///< why cyclictest has no wake-ups

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
        v("rate_hz", f.rate, "Hz", "ticks a second");
        v("extra", f.extra, "1", "blocks on the table, awake");
        v("seconds", f.seconds, "", "of the servo's turns");
        v("lateness_us", f.lateness, "us", "of a tick's beginning");
        v("tick_us", f.tick, "us", "duration of ticks, recording included");
        v("ticks", f.ticks, "1", "");
        v("overruns", f.overruns, "1", "ticks that ended after the next deadline");
        v("dropped", f.dropped, "1", "frames that were not recorded");
        v("held", f.held, "", "the block, to the end");
        v("cyclictest_us", given(peer, f.cyclictest_spread()), "us", "lateness of its wake-ups");
        v("lateness_p999_ratio", f.p999_ratio(), "1", "our p99.9 over cyclictest's");
        v("tick_p99_share", f.tick_p99_share(), "1", "of the period");
        v("slack_us", f.slack(), "us", "what a tick's p99 leaves of the period");
        v("cyclictest_late", given(peer, f.cyclictest_late()), "1", "wake-ups beyond the slack");
        v("view_hz", given(viewed, f.pictures), "Hz", "pictures drawn beside");
        v("sounds", given(f.sounds > 0, f.sounds), "1", "heard beside");
        v("overruns_without", given(f.disturbed(), f.quiet_overruns), "1",
          "in as many ticks with no view and no sound");
        v("lateness_without_us", given(f.disturbed(), f.quiet_lateness), "us", "the same");
        v("refused", given(!f.refused.empty(), f.refused), "", "what Linux refused");
    }
};

/// The load that runs beside the servo.
struct Beside {
    bool view = false;  ///< one draws as fast as it can
    /// Where to play a tone that begins twenty times a second.
    display::SoundTo sound = display::SoundTo::nowhere;

    bool sounds() const { return sound != display::SoundTo::nowhere; }
    bool anything() const { return view || sounds(); }
};

/// Two fingers hold the block in the air, and are recorded, for `seconds`, alternating with
/// cyclictest for the same time, or until `stop`. With an additional load, the servo also runs
/// without it in turn, for the same time. Throws Error when nothing can be drawn or played.
JitterFigures bench_jitter(const measure::BenchSetup& setup, double seconds, const Beside& beside,
                           const std::atomic<bool>& stop, const measure::Progress& progress);

std::string to_text(const JitterFigures& figures);

/// Median, least and most of a figure over several runs.
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

/// Several runs, to show how figures vary between runs and how many runs meet the bar.
struct JitterRuns {
    std::vector<JitterFigures> runs;

    /// Number of runs with no more overruns than cyclictest would have had.
    int within_bar() const;
    /// Of a member of JitterFigures, or what one of its functions returns.
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
