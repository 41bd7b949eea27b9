// What a thread needs of Linux to keep time: to run before ordinary programs (SCHED_FIFO), memory
// that is never fetched from disk or made on first touch, and processors that do not fall into a
// sleep that takes long to wake from. Each needs a permission that ordinary users lack; what is
// refused is told with how to allow it, and the thread runs without.
#pragma once

#include <string>

#include "base/clock.h"

namespace dihaptic::servo {

class RealTime {
  public:
    /// Asks for the calling thread, which must have its memory already: what it reserves later may
    /// not be locked. `priority`: SCHED_FIFO's, from 1 to 99.
    explicit RealTime(int priority);
    /// Gives back what was granted, from the same thread.
    ~RealTime();
    RealTime(const RealTime&) = delete;
    RealTime& operator=(const RealTime&) = delete;

    /// Each is 0 when it was granted, otherwise the system's error number.
    struct Refusals {
        int priority = 0;
        int memory = 0;
        int awake = 0;  ///< processors kept from deep sleep

        bool any() const { return priority != 0 || memory != 0 || awake != 0; }
    };
    const Refusals& refusals() const { return refusals_; }

  private:
    Refusals refusals_;
    int awake_ = -1;  // file whose being open keeps the processors awake
};

/// What was refused and how to allow it, in one line; "" when nothing was. `root`: whom the system
/// refuses although nobody may more, in a container.
std::string describe(const RealTime::Refusals& refusals, int priority, bool root);
/// The same, for who runs this process.
std::string describe(const RealTime::Refusals& refusals, int priority);

/// What a thread of this process would be refused now.
RealTime::Refusals try_real_time(int priority);

/// Deadlines a period apart that keep their phase: a tick that ends after the next deadline is an
/// overrun, and the tick after it begins at the first deadline to come. Those that passed are left
/// out, not made up for: a burst of late ticks would move the world faster than the hand.
struct Pace {
    Time period{0};
    Time due{0};  ///< of the coming tick
    int64_t overruns = 0;

    /// The tick that was due has ended.
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
