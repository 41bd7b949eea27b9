// Observers are other programs that watch a running session, and may steer it: dihaptic.observe()
// in Python, or a program of your own. They connect to a UNIX socket of the type SOCK_SEQPACKET,
// which keeps messages whole; only programs of the same user can connect. Its address is abstract
// and unpredictable: while the session runs, the file `observers` in its folder, readable by this
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
// Messages about moments arrive repeatedly, in real time; a refusal gives the reason and the
// remedy.
//
// Observers can watch any expression of recorded quantities (task/run/recorded.h). Knobs have the
// names and units of the log's columns. A slow reader misses moments, but no end of an attempt, and
// delays no other program: the tick copies its frame for the thread that serves the observers, and
// only while a program is watching.
#pragma once

#include "session/listeners/listener.h"

namespace dihaptic::session {

/// Name of the socket of the session running in this folder, after a zero. Throws Error when none
/// is running.
std::string socket_name(const std::string& folder);

/// Lets programs connect. If the session has a window, only the window can turn the knobs. Throws
/// Error when no socket can be made.
std::unique_ptr<Listener> let_observe(const Opening& opening);

}  // namespace dihaptic::session
