// Resumes a session whose trials were not all done: at the right trial, with the same inputs, and
// moved by what moved the hand before. A person's trials are never finished by a script.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// What is left of a session.
struct Rest {
    Plan plan;
    recording::SessionInfo before;  ///< info of the session that is resumed
    std::vector<Problem> warnings;  ///< from recovering the session, if it was killed

    /// Two lines: the session that is resumed and how many attempts it has done; and what moves the
    /// hand.
    std::string describe() const;
};

/// Prepares the rest of a session. Recovers the session first if it was killed, and reports the
/// progress of that to `progress`. Throws Error when nothing is left, when the session has no
/// trials, or when what moved its hand is not known or cannot do so here.
Rest rest_of(const std::string& session, Seat seat, const std::function<void(double)>& progress);

/// Keeps others from resuming that session, which nobody does twice: the trials that are left are
/// done once. Throws Error when another program resumes it now, or when a session has resumed it
/// already: one that it has a note of, or that is beside it or in the folder `out`.
recording::SessionLock claim(const std::string& session, const std::string& out);
/// Notes in a session's folder which one goes on with it. Throws Error when it cannot.
void note_successor(const std::string& session, const std::string& next);

/// A session whose trials are not all done.
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
