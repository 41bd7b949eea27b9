// Observers are other programs that watch a running session and may steer it: dihaptic.observe() in
// Python, or a program of your own. They connect to a UNIX socket of type SOCK_SEQPACKET, which
// preserves message boundaries; only programs of the same user can connect. The socket's address is
// abstract and unpredictable: while the session runs, the file `observers` in the session's folder,
// which only this user can read, contains the address without the leading zero byte. Since the
// folder may come from anywhere, a connecting program should ask the kernel who owns the answering
// program (SO_PEERCRED). Both sides send JSON objects ("it" is the observer):
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
// Messages with values arrive repeatedly, in real time. A refusal states the reason and the remedy.
//
// Observers can watch any expression of recorded quantities (task/run/recorded.h). Knobs have the
// names and units of the log's columns. A slow reader may miss values, but never the end of an
// attempt, and it does not delay other programs: the tick only copies its frame for the thread that
// serves the observers, and it does so only while a program is watching.
#pragma once

#include "session/listeners/listener.h"

namespace dihaptic::session {

/// Name of the socket of the session that is running in this folder, without the leading zero byte.
/// Throws Error when no session is running.
std::string socket_name(const std::string& folder);

/// Lets other programs connect. If the session has a window, only the window can turn the knobs.
/// Throws Error when the socket cannot be created.
std::unique_ptr<Listener> let_observe(const Opening& opening);

}  // namespace dihaptic::session
