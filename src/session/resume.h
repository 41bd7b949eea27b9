// Resumes a session with unfinished trials: at the right trial, with the same inputs, and with the
// same mover of the hand. A script never finishes a person's trials.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// The rest of a session.
struct Rest {
    Plan plan;
    recording::SessionInfo before;  ///< info of the session to be resumed
    std::vector<Problem> warnings;  ///< from recovering the session, if it was killed

    /// Two lines: the session to be resumed, with its number of attempts; and the mover of the
    /// hand.
    std::string describe() const;
};

/// Prepares the rest of a session. Recovers the session first if it was killed, reporting progress
/// to `progress`. Throws Error when no trial is left, when the session has no trials, or when the
/// mover of its hand is unknown or not available here.
Rest rest_of(const std::string& session, Seat seat, const std::function<void(double)>& progress);

/// Keeps other programs from resuming this session, so that the remaining trials are done only
/// once. Throws Error when another program is resuming it, or when a session has already resumed
/// it: one named in its folder, or one next to it or in the folder `out`.
recording::SessionLock claim(const std::string& session, const std::string& out);
/// Notes in a session's folder the session that resumes it. Throws Error when this fails.
void note_successor(const std::string& session, const std::string& next);

/// How far a session has come.
struct Standing {
    bool running = false;   ///< a program is recording or recovering it
    bool killed = false;    ///< its program ended before the session did: it must be recovered
    bool complete = false;  ///< nothing is left to do
    size_t done = 0;        ///< trials with an attempt that ended
    size_t trials = 0;
};
Standing standing_of(const recording::SessionFolder& folder, const recording::SessionInfo& info);

/// A session with unfinished trials.
struct Unfinished {
    std::string folder;
    std::string started;  ///< ISO 8601
    size_t done = 0;      ///< trials with an attempt that ended; 0 if killed and not yet recovered
    size_t trials = 0;
    recording::MovedBy moved_by;
};

/// Sessions in the folder `parent`, of that participant and experiment (title), that ended or were
/// killed before all trials were done and that no other session resumes; newest first. Leaves out
/// sessions that are running or cannot be read.
std::vector<Unfinished> find_unfinished(const std::string& parent, const std::string& title,
                                        const std::string& participant);

}  // namespace dihaptic::session
