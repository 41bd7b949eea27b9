// A listener follows a running session: it receives every Frame, and may steer. The recorder, the
// window's thread, other programs, outlets, sounds and a simulated person's eyes are listeners.
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

/// The session that listeners are made for. Its members outlive them.
struct Opening {
    const Plan& plan;
    const RunOptions& options;
    const recording::SessionFolder& folder;
    const recording::SessionInfo& info;
    const servo::Servo& servo;
    const bool real;  ///< whether it runs on the real clock
};

/// What a listener may steer in a tick.
struct Steering {
    const frame::Frame& last;   ///< the Frame before this tick; see frame::Director
    task::TaskDirector* task;   ///< runs the trials, after all listeners; null without trials
    frame::Commands& commands;  ///< orders of this tick
    Time period;                ///< its length
    bool real;                  ///< whether the session runs on the real clock

    /// True in one tick of each second.
    bool is_once_a_second() const noexcept {
        return (last.time + period) % std::chrono::seconds(1) < period;
    }
};

/// A constructor, or a function that makes a listener, reserves all memory that the ticks need. It
/// throws Error when the listener cannot do its work.
class Listener {
  public:
    Listener() = default;
    virtual ~Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    /// Called in the tick, before the orders of the trials: passes on what a person or program
    /// requests. Neither waits nor allocates.
    virtual void steer(const Steering& /*steering*/) noexcept {}
    /// Called in the tick, once its Frame is made. On the real clock it neither waits nor
    /// allocates.
    virtual void take(const frame::Frame& frame) noexcept = 0;
    /// Whether the session must end; called in the tick and from other threads.
    virtual bool ends() const noexcept { return false; }
    /// Called after the last tick: returns messages for the session's notes. Throws Error when the
    /// session's record is not complete.
    virtual std::vector<std::string> finish() { return {}; }
};

}  // namespace dihaptic::session
