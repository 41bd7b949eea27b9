#include "bench/jitter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/number.h"
#include "base/plural.h"
#include "bench/bench_log.h"
#include "bench/drawing.h"
#include "recording/hearings.h"
#include "sound/player.h"

namespace dihaptic::bench {
namespace {

// our turn, then cyclictest's: short enough for the machine's other load to affect both equally [s]
constexpr double kTurn = 5;

/// Lifts the block on the virtual clock; returns the time at which it is held.
Time lift(measure::Bench& bench) {
    const double held = bench.driver().phases()[measure::kRise].end;
    Time reached{0};
    bench.run([&](const frame::Frame& frame) { reached = frame.time; },
              [&](const frame::Frame& last, std::span<const frame::Handle>,
                  frame::Commands& commands) { commands.stop = seconds(last.time) >= held; });
    return reached;
}

/// A tone that a servo's ticks start repeatedly.
class Tone {
  public:
    Tone(display::SoundTo to, const servo::Servo& servo, const recording::SessionFolder& folder)
        : folder_(folder) {
        task::SoundSpec tone;
        tone.name = "tone";
        tone.tone = 440;
        tone.duration = 0.02;
        display::SoundOutput output;
        output.to = to;
        const std::vector sounds{tone};
        player_.emplace(sound::Player::Plan{sounds, output, 1, true}, folder);
        servo.reserve(due_);
    }

    void hear(const frame::Frame& frame) noexcept {
        due_.sequence = frame.sequence;
        due_.time = frame.time;
        due_.task.sounds.clear();
        if (frame.time >= next_) {
            due_.task.sounds.push_back({0, 1});
            next_ = frame.time + kInterval;
        }
        player_->hear(due_);
    }
    /// Returns the number of times it was heard.
    int64_t finish() {
        for (const std::string& problem : player_->finish()) throw Error(problem, "Try again.");
        player_.reset();  // this writes the last lines of its file
        return static_cast<int64_t>(recording::read_hearings(folder_).size());
    }

  private:
    static constexpr Time kInterval = std::chrono::milliseconds(50);

    const recording::SessionFolder& folder_;
    frame::Frame due_;
    Time next_{0};
    std::optional<sound::Player> player_;
};

/// A block held in real time, in several turns, with a recording.
class HeldBlock {
  public:
    explicit HeldBlock(const measure::BenchSetup& setup)
        : scene_(measure::grasp_scene(setup)),
          bench_(scene_, measure::grasp_hand(setup), setup),
          log_(scene_, setup.settings),
          reached_(lift(bench_)) {
        for (frame::Frame& frame : newest_.values()) bench_.servo().reserve(frame);
    }

    /// Holds the block for `turn` [s]; `published`: publishes the frames for a view to draw.
    /// `tone`: gets the ticks, unless it is null.
    void hold(servo::Timing& timing, double turn, bool published, Tone* tone,
              const std::atomic<bool>& stop) {
        recording::Recorder recorder = log_.record(recording::Writing::in_thread);
        const Time period = bench_.servo().period();
        const Time first = reached_ + period;
        servo::run_real(
            bench_.servo(), {},
            [&](const frame::Frame& frame) {
                recorder.record(frame);
                if (published) newest_.publish(frame);
                if (tone != nullptr) tone->hear(frame);
                height_ = frame.bodies[1].X_WB.p.z();
            },
            first, first + from_seconds(turn) - period, stop, timing);
        reached_ = timing.reached;
        recorder.finish();
        dropped_ += recorder.dropped();
    }
    /// Holds it with the additional load, except the view; returns the number of sounds heard.
    int64_t hold(servo::Timing& timing, double turn, const Beside& beside,
                 const std::atomic<bool>& stop) {
        if (!beside.sounds()) {
            hold(timing, turn, beside.view, nullptr, stop);
            return 0;
        }
        const TemporaryFolder parent;
        const auto folder = recording::SessionFolder::create(parent.path(), "jitter");
        Tone tone(beside.sound, bench_.servo(), folder);
        hold(timing, turn, beside.view, &tone, stop);
        return tone.finish();
    }

    const scene::Scene& scene() const { return scene_; }
    const BenchLog& log() const { return log_; }
    Latest<frame::Frame>& newest() { return newest_; }
    bool held() const { return height_ - measure::kBlockSize / 2 >= 0.09; }
    int64_t dropped() const { return dropped_; }

  private:
    scene::Scene scene_;
    measure::Bench bench_;
    BenchLog log_;
    Latest<frame::Frame> newest_;
    Time reached_;
    double height_ = 0;    // [m]
    int64_t dropped_ = 0;  // number of unrecorded frames
};

Spread spread(const auto& times) {
    return {times.quantile(0.5), times.quantile(0.99), times.quantile(0.999), times.quantile(1)};
}

constexpr std::array kSteps{0, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};

/// A count as a bar whose length is its logarithm, since rare events matter here.
std::string bar(int64_t count) {
    const auto length = count > 0 ? static_cast<size_t>(std::log2(count)) + 1 : 0;
    return fmt::format("{:<22s} {:8d}", std::string(length, '#'), count);
}

std::string beside_text(const JitterFigures& f) {
    std::string out;
    if (f.pictures > 0)
        out += fmt::format("a view drew {:.0f} pictures per second meanwhile\n", f.pictures);
    if (f.sounds > 0)
        out += fmt::format("{} heard during the servo's turns\n", counted(f.sounds, "sound"));
    if (f.disturbed())
        out += fmt::format(
            "without these: {} in the same number of ticks; p99.9 of lateness {:.1f} us\n",
            counted(f.quiet_overruns, "overrun"), f.quiet_lateness.p999);
    return out;
}

void add_timing(JitterFigures& figures, const servo::Timing& timing, int priority) {
    figures.ticks = static_cast<int64_t>(timing.ticks.count());
    figures.lateness = spread(timing.lateness);
    figures.tick = spread(timing.ticks);
    figures.overruns = timing.overruns;
    figures.refused = servo::describe(timing.refusals, priority);
    for (const float us : timing.lateness.us()) figures.wakeups.add(static_cast<int>(us));
}

}  // namespace

double JitterFigures::p999_ratio() const {
    return lateness.p999 / cyclictest.quantile(0.999);
}

Spread JitterFigures::cyclictest_spread() const {
    return spread(cyclictest);
}

JitterFigures bench_jitter(const measure::BenchSetup& base, double whole, const Beside& beside,
                           const std::atomic<bool>& stop, const measure::Progress& progress) {
    const bool disturbed = beside.anything();
    measure::BenchSetup setup = base;
    setup.settings.dynamics.sleeping = setup.extra_blocks == 0;
    setup.hold_time = (disturbed ? 2 : 1) * whole + kTurn;
    HeldBlock block(setup);
    JitterFigures figures;
    figures.rate = setup.settings.rate;
    figures.extra = setup.extra_blocks;
    servo::Timing timing;
    servo::Timing quiet;
    const auto most = static_cast<size_t>(whole * setup.settings.rate) + 2;
    timing.reserve(most);
    if (disturbed) quiet.reserve(most);
    int64_t pictures = 0;
    while (figures.seconds < whole - 1e-9 && !stop) {
        const double turn = std::min(kTurn, whole - figures.seconds);
        const auto say = [&](const char* what, double done) {
            if (progress) progress(what, (figures.seconds + done * turn) / whole);
        };
        if (disturbed) {
            say("servo alone", 0);
            block.hold(quiet, turn, beside.view, nullptr, stop);
        }
        std::optional<Drawing> drawing;
        if (beside.view) drawing.emplace(block.scene(), block.newest());
        say("servo", disturbed ? 0.33 : 0);
        figures.sounds += block.hold(timing, turn, beside, stop);
        if (figures.no_cyclictest.empty() && !stop) {
            say("cyclictest", disturbed ? 0.67 : 0.5);
            const Cyclictest peer{setup.settings, timing.refusals.priority == 0,
                                  timing.refusals.memory == 0, block.log().file("cyclictest.json")};
            figures.no_cyclictest = run_cyclictest(peer, turn, figures.cyclictest);
        }
        if (drawing) pictures += drawing->pictures();
        drawing.reset();
        figures.seconds += turn;
    }
    const double drawn = (figures.no_cyclictest.empty() ? 2 : 1) * figures.seconds;
    figures.pictures = static_cast<double>(pictures) / drawn;
    figures.quiet_overruns = quiet.overruns;
    figures.quiet_lateness = spread(quiet.lateness);
    figures.dropped = block.dropped();
    figures.held = block.held();
    add_timing(figures, timing, setup.settings.real_time_priority);
    return figures;
}

OfRuns JitterRuns::sorted(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const size_t middle = values.size() / 2;
    const double median =
        values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
    return {median, values.front(), values.back()};
}

int JitterRuns::within_bar() const {
    return static_cast<int>(std::count_if(runs.begin(), runs.end(), [](const JitterFigures& f) {
        return f.overruns <= f.cyclictest_late();
    }));
}

std::string to_text(const JitterRuns& all) {
    const JitterFigures& first = all.runs.front();
    std::string out = fmt::format(
        "{} of {:g} s at {:g} Hz{}\n\n"
        "run      overruns  cyclictest's  p99.9 over cyclictest's  tick's p99, % of the period\n",
        counted(static_cast<int64_t>(all.runs.size()), "run"), first.seconds, first.rate,
        first.extra > 0 ? fmt::format(", {} awake on the table", counted(first.extra, "more block"))
                        : "");
    const auto row = [&](const std::string& name, double ours, double theirs, double ratio,
                         double share) {
        out += fmt::format("{:7s} {:9.0f} {:13.0f} {:24.2f} {:28.1f}\n", name, ours, theirs, ratio,
                           100 * share);
    };
    for (size_t i = 0; i < all.runs.size(); ++i) {
        const JitterFigures& f = all.runs[i];
        row(number_text(i + 1), static_cast<double>(f.overruns),
            static_cast<double>(f.cyclictest_late()), f.p999_ratio(), f.tick_p99_share());
    }
    const OfRuns ours = all.over(&JitterFigures::overruns);
    const OfRuns theirs = all.over(&JitterFigures::cyclictest_late);
    const OfRuns ratio = all.over(&JitterFigures::p999_ratio);
    const OfRuns share = all.over(&JitterFigures::tick_p99_share);
    row("least", ours.least, theirs.least, ratio.least, share.least);
    row("median", ours.median, theirs.median, ratio.median, share.median);
    row("most", ours.most, theirs.most, ratio.most, share.most);
    if (!first.no_cyclictest.empty()) return out + "no peer: " + first.no_cyclictest + "\n";
    return out +
           fmt::format("bar: no more overruns than cyclictest's in each run; met in {} of {}\n",
                       all.within_bar(), all.runs.size());
}

std::string to_text(const JitterFigures& f) {
    std::string out = fmt::format(
        "two fingers hold a block for {:g} s at {:g} Hz{}\n\n"
        "us                    median      p99    p99.9       max\n",
        f.seconds, f.rate,
        f.extra > 0 ? fmt::format(", {} awake on the table", counted(f.extra, "more block")) : "");
    const auto row = [&](const char* name, const Spread& s, int decimals) {
        out += fmt::format("{:18s} {:9.{}f} {:8.{}f} {:8.{}f} {:9.{}f}\n", name, s.median, decimals,
                           s.p99, decimals, s.p999, decimals, s.max, decimals);
    };
    const bool peer = f.cyclictest.count() > 0;
    row("lateness", f.lateness, 1);
    if (peer) row("cyclictest's", f.cyclictest_spread(), 0);
    row("tick", f.tick, 1);
    out += fmt::format(
        "\nwake-ups by lateness, us; each further # doubles the count\n{:>14s}  {:34s}{}\n", "",
        "servo", peer ? "cyclictest" : "");
    for (size_t i = 0; i < kSteps.size(); ++i) {
        const bool last = i + 1 == kSteps.size();
        const auto within = [&](const Wakeups& w) {
            return w.later_than(kSteps[i] - 1) - (last ? 0 : w.later_than(kSteps[i + 1] - 1));
        };
        const int64_t ours = within(f.wakeups);
        const int64_t theirs = within(f.cyclictest);
        if (ours == 0 && theirs == 0) continue;
        out += fmt::format("{:>14s}  {:34s}{}\n",
                           last ? fmt::format("from {}", kSteps[i])
                                : fmt::format("{} to {}", kSteps[i], kSteps[i + 1]),
                           bar(ours), peer ? bar(theirs) : "");
    }
    out +=
        fmt::format("\n{} in {}; a tick's p99 is {:.1f} % of the period, which leaves {:.0f} us\n",
                    counted(f.overruns, "overrun"), counted(f.ticks, "tick"),
                    100 * f.tick_p99_share(), f.slack());
    if (peer) {
        out += fmt::format(
            "cyclictest woke later than that {}; p99.9 of lateness is {:.2f} times cyclictest's\n",
            counted(f.cyclictest_late(), "time"), f.p999_ratio());
    } else {
        out += "no peer: " + f.no_cyclictest + "\n";
    }
    out += beside_text(f);
    if (f.dropped > 0) out += fmt::format("{} not recorded\n", counted(f.dropped, "frame"));
    if (!f.held) out += "the block was NOT held\n";
    if (!f.refused.empty()) out += "note: " + f.refused + "\n";
    return out;
}

}  // namespace dihaptic::bench
