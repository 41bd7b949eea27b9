// Onlookers are other programs that watch a running session, and may steer it: dihaptic.observe()
// in Python, or a program of your own. They connect to a UNIX socket of the type SOCK_SEQPACKET,
// which keeps messages whole; only programs of the same user can connect. Its address is abstract
// and unpredictable: while the session runs, the file `onlookers` in its folder, readable by this
// user alone, contains the address without the leading zero. A connecting program asks the kernel
// for the owner of the answering program (SO_PEERCRED), because a folder may come from anywhere.
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
// Moments arrive repeatedly, in real time; a refusal gives the reason and the remedy.
//
// Onlookers can watch any expression of recorded quantities (task/run/recorded.h). Knobs have the
// names and units of the log's columns. A slow reader misses moments, but no end of an attempt, and
// delays no other program: the tick copies its frame for the thread that does all this, and only
// while a program is watching.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// Name of the socket of the session running in this folder, after a zero. Throws Error when none
/// is running.
std::string socket_name(const std::string& folder);

class Onlookers {
  public:
    /// `knobs_elsewhere`: the operator's window turns the knobs, so that no onlooker can.
    Onlookers(const Plan& plan, const std::string& folder, bool real, bool knobs_elsewhere);
    ~Onlookers();
    Onlookers(const Onlookers&) = delete;
    Onlookers& operator=(const Onlookers&) = delete;

    /// Call before the first tick: reserves memory, and lets programs connect. Throws Error when no
    /// socket can be made.
    void open(const servo::Servo& servo, const std::vector<std::string>& states,
              const std::vector<std::string>& outcomes);

    // Called in the tick; none of these waits or allocates.
    void show(const frame::Frame& frame) noexcept;
    /// The key that an onlooker pressed since the last call; 0: none.
    char take_key() noexcept;
    /// The trigger that an onlooker sent since the last call; 0: none.
    int take_trigger() noexcept;
    bool ended() const noexcept;
    void turn_knobs(const frame::Frame& last, double h, frame::Knobs& now) noexcept;

    /// Tells onlookers that the session is over; returns their actions, in sentences.
    std::vector<std::string> finish();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::session
