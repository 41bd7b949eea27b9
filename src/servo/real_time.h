// RealTime requests the resources that a thread needs to keep time: priority over ordinary programs
// (SCHED_FIFO), memory that is never fetched from disk or created on first touch, and processors
// that do not enter a sleep with slow wake-up. Each needs a permission that ordinary users lack.
// Any refusal is reported, together with how to grant the permission, and the thread then runs
// without that resource.
#pragma once

#include <string>

#include "base/clock.h"
#include "base/descriptor.h"

namespace dihaptic::servo {

class RealTime {
  public:
    /// Requests the resources for the calling thread, which must already have reserved its memory:
    /// memory allocated later might not be locked. `priority` is for SCHED_FIFO, from 1 to 99.
    explicit RealTime(int priority);
    /// Returns the granted resources. Must be called by the same thread.
    ~RealTime();
    RealTime(const RealTime&) = delete;
    RealTime& operator=(const RealTime&) = delete;

    /// For each resource, 0 if it was granted, otherwise the system's error number.
    struct Refusals {
        int priority = 0;
        int memory = 0;
        int awake = 0;  ///< for keeping the processors from deep sleep

        bool any() const { return priority != 0 || memory != 0 || awake != 0; }
    };
    const Refusals& refusals() const { return refusals_; }

  private:
    Refusals refusals_;
    Descriptor awake_;  // while this file is open, the processors stay awake
};

/// Describes in one line the refusals and how to allow them; "" without refusals. `root`: whether
/// the process runs as root and was nevertheless refused, as in a container.
std::string describe(const RealTime::Refusals& refusals, int priority, bool root);
/// The same, for the user who runs this process.
std::string describe(const RealTime::Refusals& refusals, int priority);

/// The refusals that a thread of this process would get now.
RealTime::Refusals try_real_time(int priority);

/// Deadlines one period apart that keep their phase. A tick that ends after the next deadline is an
/// overrun, and the tick after it starts at the next deadline. Missed deadlines are skipped
/// and not made up for: a burst of late ticks would move the world faster than the hand.
struct Pace {
    Time period{0};
    Time due{0};  ///< deadline of the coming tick
    int64_t overruns = 0;

    /// Notes that the due tick has ended.
    void end_tick(Time now) noexcept {
        due += period;
        late = now > due;
        if (!late) return;
        ++overruns;
        due += ((now - due) / period + 1) * period;
    }
    bool late = false;  ///< whether the last tick was an overrun
};

}  // namespace dihaptic::servo
