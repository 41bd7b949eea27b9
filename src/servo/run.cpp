#include "servo/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <thread>

#include "base/statistics.h"
#include "servo/suspension.h"
#include "servo/watchdog.h"

namespace dihaptic::servo {
namespace {

using Steady = std::chrono::steady_clock;

/// Time that devices which call the ticks may need before their first tick, to start a thread or
/// scheduler of their own. No force is applied during this time, so the watchdog can wait longer
/// than any device needs.
constexpr Time kDevicesBegin = std::chrono::seconds(4);
/// Time that these devices may need after their last tick, in which force was switched off, to end
/// that thread or scheduler.
constexpr Time kDevicesEnd = std::chrono::seconds(2);

double elapsed(Steady::time_point since) {
    return std::chrono::duration<double>(Steady::now() - since).count();
}

void sleep_until(Steady::time_point deadline) {
    // steady_clock is CLOCK_MONOTONIC here; sleeping until an absolute time avoids drift
    const auto since_epoch = deadline.time_since_epoch();
    timespec at{};
    at.tv_sec = std::chrono::duration_cast<std::chrono::seconds>(since_epoch).count();
    at.tv_nsec = (since_epoch - std::chrono::seconds(at.tv_sec)).count();
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
    }
}

}  // namespace

double TickTimes::quantile(double share) const {
    return dihaptic::quantile(us_, share);
}

std::string describe(const Timing& timing) {
    if (timing.lateness.count() == 0) return "";
    return fmt::format("wake-ups late by {:.0f} us median, {:.0f} us p99.9, {:.0f} us at worst",
                       timing.lateness.quantile(0.5), timing.lateness.quantile(0.999),
                       timing.lateness.quantile(1));
}

std::string describe_pauses(const Timing& timing) {
    if (timing.pauses == 0) return "";
    return fmt::format(
        "the simulated devices waited longer than allowed {}, {:.0f} ms at "
        "worst: real devices would have been switched off",
        timing.pauses == 1 ? "once" : fmt::format("{} times", timing.pauses),
        timing.longest_pause * 1e3);
}

std::string describe(const Timing::Stall& stall) {
    return fmt::format("no tick had ended for {:.0f} ms at {:.3f} s, and {}",
                       seconds(stall.pause) * 1e3, seconds(stall.at),
                       stall.stopped ? "the watchdog switched the devices' force off"
                                     : "the watchdog could not switch the devices' force off");
}

Time run_virtual(Servo& servo, const frame::Director& director, const frame::FrameSink& sink,
                 Time most, const std::atomic<bool>& stop, TickTimes* times) {
    Time now{0};
    const auto tick = [&] {
        if (now > most || stop.load(std::memory_order_relaxed)) return false;
        const auto begin = Steady::now();
        const frame::Frame& frame = servo.tick(now, director);
        if (sink) sink(frame);
        if (times != nullptr) times->add(elapsed(begin));
        if (servo.stopped()) return false;
        now += servo.period();
        return true;
    };
    if (servo.devices().paces()) {
        servo.pace(tick);
    } else {
        while (tick()) {
        }
    }
    return now;
}

namespace {

/// A run on the real clock. Belongs to the thread that calls the ticks.
struct RealLoop {
    Servo& servo;
    const frame::Director& director;
    const frame::FrameSink& sink;
    const std::atomic<bool>& stop;
    Timing& timing;
    Watchdog& watchdog;
    Steady::time_point start;  ///< when session time was zero or (in a resumed run) would have been
    double last_tick = kUnmeasured;
    bool overrun = false;
    Suspension suspension{Suspension::read()};

    /// Does the tick for time `now`, which was due at time `due`. Returns whether another tick
    /// follows.
    bool tick(Time due, Time now, Steady::time_point begin) noexcept {
        const double lateness = seconds(begin - (start + due));
        servo.note_timing({lateness, last_tick, overrun});
        const frame::Frame& frame = servo.tick(now, director);
        if (sink) sink(frame);
        if ((frame.status & kLate) != 0 && !servo.real()) {
            ++timing.pauses;
            timing.longest_pause =
                std::max({timing.longest_pause, seconds(now - timing.reached), lateness});
        }
        const auto end = Steady::now();
        // after the last tick, force is off, and the devices may need some time to shut down
        watchdog.end_tick(servo.stopped() ? end + kDevicesEnd : end);
        last_tick = seconds(end - begin);
        timing.ticks.add(last_tick);
        timing.lateness.add(lateness);
        timing.reached = now;
        return !servo.stopped();
    }

    /// If the machine was suspended, adds the duration of the suspension, in whole periods, to the
    /// run's time, because the monotonic clock stands still during a suspension.
    Time add_suspension() noexcept {
        const Time asleep = suspension.since(Suspension::read());
        const Time added = (asleep / servo.period()) * servo.period();
        start -= added;
        return added;
    }

    void run_by_deadlines(Time first, Time last) {
        Pace pace{servo.period(), first};
        while (pace.due <= last && !stop.load(std::memory_order_relaxed)) {
            sleep_until(start + pace.due);
            pace.due += add_suspension();
            if (!tick(pace.due, pace.due, Steady::now())) break;
            pace.end_tick(Steady::now() - start);
            overrun = pace.late;
        }
        timing.overruns += pace.overruns;
    }

    /// Measures time here, because the devices' period is close to the servo's but not equal to it.
    /// A tick is an overrun if it took longer than a period, or if the devices called it more than
    /// half a period late: in both cases the last force was held longer than intended.
    void run_by_devices(Time first, Time last) {
        Time due = first;
        bool begun = false;
        servo.pace([&] {
            const auto begin = Steady::now();
            if (!begun) start = begin - first;
            begun = true;
            add_suspension();
            const Time now = begin - start;
            if (now > last || stop.load(std::memory_order_relaxed)) return false;
            overrun = last_tick > seconds(servo.period()) || now - due > servo.period() / 2;
            if (overrun) ++timing.overruns;
            const bool on = tick(due, now, begin);
            due = now + servo.period();
            return on;
        });
    }
};

}  // namespace

void run_real(Servo& servo, const frame::Director& director, const frame::FrameSink& sink,
              Time first, Time last, const std::atomic<bool>& stop, Timing& timing,
              const std::function<void(const Timing::Stall&)>& stuck) {
    std::thread thread([&] {
        const RealTime real_time(servo.settings().real_time_priority);
        timing.refusals = real_time.refusals();
        auto start = Steady::now();
        // one tick longer than the servo allows: if the watchdog stops the devices, the servo then
        // also finds (and records) that the next tick is late, except when this is the first tick
        const Time pause = from_seconds(servo.settings().safety.max_pause) + servo.period();
        // if all devices are simulated, nobody holds them, so only a stuck loop matters
        const Time limit = servo.real() ? pause : Watchdog::kStuck;
        std::optional<Timing::Stall> stall;  // owned by the watchdog's thread until it has ended
        auto watchdog = std::make_unique<Watchdog>(
            limit,
            [&] {
                const bool stopped = servo.real() && servo.stop_devices();
                stall = {Steady::now() - start, limit, stopped};
            },
            [&] {
                if (stuck) stuck(*stall);
            });
        // taken only now, because starting the watchdog's thread may take longer than a tick
        start = Steady::now() + servo.period() - first;
        // devices that call the ticks may need some time to start
        const bool paced = servo.devices().paces();
        watchdog->end_tick(Steady::now() + (paced ? kDevicesBegin : Time(0)));
        RealLoop loop{servo, director, sink, stop, timing, *watchdog, start};
        if (paced) {
            loop.run_by_devices(first, last);
        } else {
            loop.run_by_deadlines(first, last);
        }
        watchdog.reset();
        if (stall && servo.real()) timing.stall = stall;
    });
    thread.join();
}

}  // namespace dihaptic::servo
