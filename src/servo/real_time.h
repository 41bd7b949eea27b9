// RealTime requests the resources that a thread needs to run in real time: priority over ordinary
// programs (SCHED_FIFO), memory that is never swapped out and causes no page faults, and processors
// that do not enter sleep states from which they wake up slowly. Each of these requires a
// permission that ordinary users lack. If a request is refused, the refusal is reported together
// with how to grant the permission, and the thread runs without that resource.
#pragma once

#include <string>

#include "base/clock.h"
#include "base/descriptor.h"

namespace dihaptic::servo {

class RealTime {
  public:
    /// Requests the resources for the calling thread, which must already have allocated all of its
    /// memory: memory allocated later might not be locked. `priority` is the SCHED_FIFO priority,
    /// from 1 to 99.
    explicit RealTime(int priority);
    /// Releases the granted resources. Must be called by the same thread.
    ~RealTime();
    RealTime(const RealTime&) = delete;
    RealTime& operator=(const RealTime&) = delete;

    /// For each resource: 0 if it was granted, otherwise the system's error number.
    struct Refusals {
        int priority = 0;
        int memory = 0;
        int awake = 0;  ///< request to keep the processors out of deep sleep

        bool any() const { return priority != 0 || memory != 0 || awake != 0; }
    };
    const Refusals& refusals() const { return refusals_; }

  private:
    Refusals refusals_;
    Descriptor awake_;  // the processors stay awake as long as this file is open
};

/// Describes the refusals, and how to grant the permissions, in one line; "" if there were no
/// refusals. `root` states whether the process was refused although it runs as root, as in a
/// container.
std::string describe(const RealTime::Refusals& refusals, int priority, bool root);
/// The same as above, for the user who runs this process.
std::string describe(const RealTime::Refusals& refusals, int priority);

/// Returns the refusals that a thread of this process would get at present.
RealTime::Refusals try_real_time(int priority);

/// Computes deadlines that are a whole number of periods apart. A tick that ends after the next
/// deadline is an overrun, and the tick after it starts at the first deadline that is still to
/// come. Missed deadlines are skipped, not made up for: a burst of ticks would move the world
/// faster than the hand.
struct Pace {
    Time period{0};
    Time due{0};  ///< deadline of the next tick
    int64_t overruns = 0;

    /// Notes that the tick of the current deadline has ended.
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
