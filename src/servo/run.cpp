#include "servo/run.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <thread>

namespace dihaptic::servo {
namespace {

using Steady = std::chrono::steady_clock;

double elapsed(Steady::time_point since) {
    return std::chrono::duration<double>(Steady::now() - since).count();
}

void sleep_until(Steady::time_point deadline) {
    // steady_clock is CLOCK_MONOTONIC here; an absolute sleep does not drift
    const auto since_epoch = deadline.time_since_epoch();
    timespec at{};
    at.tv_sec = std::chrono::duration_cast<std::chrono::seconds>(since_epoch).count();
    at.tv_nsec = (since_epoch - std::chrono::seconds(at.tv_sec)).count();
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
    }
}

}  // namespace

double TickTimes::quantile(double share) const {
    if (us_.empty()) return kUnmeasured;
    std::vector<float> sorted = us_;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
    return sorted[static_cast<size_t>(at)];
}

Time run_virtual(Servo& servo, const Director& director, const FrameSink& sink, Time most,
                 const std::atomic<bool>& stop, TickTimes* times) {
    Time now{0};
    for (; now <= most && !stop.load(std::memory_order_relaxed); now += servo.period()) {
        const auto begin = Steady::now();
        const Frame& frame = servo.tick(now, director);
        if (sink) sink(frame);
        if (times != nullptr) times->add(elapsed(begin));
        if (servo.stopped()) break;
    }
    return now;
}

RealTimeResult run_real(Servo& servo, const Director& director, const FrameSink& sink, Time most,
                        const std::atomic<bool>& stop, TickTimes& times,
                        std::atomic<int64_t>& reached) {
    RealTimeResult result;
    std::thread thread([&] {
        const auto start = Steady::now();
        double last_tick = kUnmeasured;
        bool overrun = false;
        Time now{0};
        while (now <= most && !stop.load(std::memory_order_relaxed)) {
            sleep_until(start + now);
            const auto begin = Steady::now();
            servo.note_timing(std::chrono::duration<double>(begin - (start + now)).count(),
                              last_tick, overrun);
            const Frame& frame = servo.tick(now, director);
            if (sink) sink(frame);
            last_tick = elapsed(begin);
            times.add(last_tick);
            result.reached = now;
            reached.store(now.count(), std::memory_order_relaxed);
            if (servo.stopped()) break;
            now += servo.period();
            const Time late = Steady::now() - (start + now);
            overrun = late > Time(0);
            if (overrun) {
                ++result.overruns;
                now += late / servo.period() * servo.period();
            }
        }
    });
    thread.join();
    return result;
}

}  // namespace dihaptic::servo
