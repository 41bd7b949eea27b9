// Onlookers are other programs that watch a running session, and may steer it: dihaptic.observe()
// of Python, or one's own. They connect to a UNIX socket of the kind SOCK_SEQPACKET, in which every
// message is a whole one; only programs of the same user can. Its address is an abstract one that
// nobody can foresee: while the session runs, the file `onlookers` in its folder, which this user
// alone may read, has it, without the zero before it. Whoever connects asks the kernel whose
// program answers (SO_PEERCRED): a folder may come from anywhere.
// Both sides send objects of JSON:
//
//   session  {"session": "sessions/...", "clock": "real", "states": [...], "outcomes": [...]}
//   it       {"watch": ["grip_force", "block.z"], "every_ms": 20}
//   session  {"watching": [{"of": "grip_force", "unit": "N"}, {"of": "block.z", "unit": "mm"}]}
//   session  {"tick": 12, "time_s": 0.012, "trial_num": 1, "attempt": 1, "state": "reach",
//             "values": [2.1, 14.5]}
//   session  {"tick": 90, "time_s": 0.09,
//             "ended": {"trial_num": 1, "attempt": 1, "outcome": "hit"}}
//   it       {"key": "y"}
//   it       {"trigger": 5}
//   it       {"turn": {"stiffness": 800}}
//   it       {"end": true}
//   session  {"refused": "..."}
//   session  {"over": true}
//
// Moments come again and again, in real time; what is refused says why, and what to do.
//
// What is watched is any expression of what is recorded (task/run/recorded.h). Knobs have the names
// of the log's columns, and their units. A reader that is slow misses moments, but no end of an
// attempt, and holds nobody up: the tick copies its frame for the thread that does all this, and
// only while somebody watches.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// Name of the socket of a session that runs in that folder, behind a zero. Throws Error when none
/// does.
std::string socket_name(const std::string& folder);

class Onlookers {
  public:
    /// `knobs_elsewhere`: the operator's window turns them, and no onlooker can.
    Onlookers(const Plan& plan, const std::string& folder, bool real, bool knobs_elsewhere);
    ~Onlookers();
    Onlookers(const Onlookers&) = delete;
    Onlookers& operator=(const Onlookers&) = delete;

    /// Call before the first tick: reserves memory, and lets others connect. Throws Error when
    /// there can be no socket.
    void open(const servo::Servo& servo, const std::vector<std::string>& states,
              const std::vector<std::string>& outcomes);

    // In the tick; none of them waits or allocates.
    void show(const frame::Frame& frame) noexcept;
    /// What an onlooker pressed since the last call; 0: nothing.
    char take_key() noexcept;
    /// The trigger that one sent since the last call; 0: none.
    int take_trigger() noexcept;
    bool ended() const noexcept;
    void turn_knobs(const frame::Frame& last, double h, frame::Knobs& now) noexcept;

    /// Tells them that the session is over; returns what they did, in sentences.
    std::vector<std::string> finish();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::session
