// A listener follows a running session: it receives every Frame and may steer the session. The
// recorder, the window's thread, other programs, outlets, sounds and the eyes of a simulated person
// are listeners.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "frame/orders.h"
#include "recording/session.h"
#include "servo/servo.h"

namespace dihaptic::task {
class TaskDirector;
}

namespace dihaptic::session {

struct Plan;
struct RunOptions;

/// The session for which listeners are created. The objects that its members refer to outlive the
/// listeners.
struct Opening {
    const Plan& plan;
    const RunOptions& options;
    const recording::SessionFolder& folder;
    const recording::SessionInfo& info;
    const servo::Servo& servo;
    const bool real;  ///< whether the session runs on the real clock
};

/// What a listener can use to steer the session in a tick.
struct Steering {
    const frame::Frame& last;   ///< the Frame of the previous tick; see frame::Director
    task::TaskDirector* task;   ///< runs the trials, after all listeners; null without trials
    frame::Commands& commands;  ///< orders for this tick
    Time period;                ///< its length
    bool real;                  ///< whether the session runs on the real clock

    /// True in one tick per second.
    bool is_once_a_second() const noexcept {
        return (last.time + period) % std::chrono::seconds(1) < period;
    }
};

/// All memory needed in ticks is reserved by a listener's constructor or by the function that
/// creates the listener. Either throws Error when the listener cannot do its work.
class Listener {
  public:
    Listener() = default;
    virtual ~Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    /// Called in each tick, before the trials give their orders: passes on the requests of a person
    /// or program. Neither waits nor allocates memory.
    virtual void steer(const Steering& /*steering*/) noexcept {}
    /// Called in each tick, once the tick's Frame is complete. On the real clock, take() neither
    /// waits nor allocates memory.
    virtual void take(const frame::Frame& frame) noexcept = 0;
    /// Whether the session must end. Called in the tick and also from other threads.
    virtual bool ends() const noexcept { return false; }
    /// Called after the last tick. Returns messages for the session's notes. Throws Error if the
    /// recording of the session is incomplete.
    virtual std::vector<std::string> finish() { return {}; }
};

}  // namespace dihaptic::session
