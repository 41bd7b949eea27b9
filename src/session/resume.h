// Resumes a session that has unfinished trials: at the right trial, with the same inputs, and with
// the same mover of the hand. A script never finishes the trials of a person.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "session/plan.h"

namespace dihaptic::session {

/// The remaining part of a session.
struct Rest {
    Plan plan;
    recording::SessionInfo before;  ///< session.yaml of the session to be resumed
    std::vector<Problem> warnings;  ///< warnings from recovering the session, if it was killed

    /// Returns two lines: the session to be resumed, with its number of attempts; and the mover of
    /// the hand.
    std::string describe() const;
};

/// Prepares the rest of a session. If the session was killed, recovers it first, reporting progress
/// to `progress`. Throws Error when no trial is left, when the session has no trials, or when the
/// mover of its hand is unknown or cannot be used here.
Rest rest_of(const std::string& session, Seat seat, const std::function<void(double)>& progress);

/// Locks the session so that no other program can resume it, and the remaining trials are done only
/// once. Throws Error when another program is resuming the session, or when another session has
/// already resumed it: a session named in its folder, in the same parent folder, or in the folder
/// `out`.
recording::SessionLock claim(const std::string& session, const std::string& out);
/// Stores, in the folder of `session`, which session resumes it. Throws Error when this fails.
void note_successor(const std::string& session, const std::string& next);

/// How much of a session has been done.
struct Standing {
    bool running = false;   ///< whether a program is recording or recovering the session
    bool killed = false;    ///< whether its program ended too early, so that it needs recovery
    bool complete = false;  ///< whether nothing is left to do
    size_t done = 0;        ///< number of trials with an attempt that ended
    size_t trials = 0;
};
Standing standing_of(const recording::SessionFolder& folder, const recording::SessionInfo& info);

/// A session with unfinished trials.
struct Unfinished {
    std::string folder;
    std::string started;  ///< ISO 8601
    size_t done = 0;      ///< number of trials with an attempt that ended; 0 if not yet recovered
    size_t trials = 0;
    recording::MovedBy moved_by;
};

/// Returns the sessions in the folder `parent`, with this participant and experiment title, that
/// ended or were killed before all trials were done and that no other session resumes; newest
/// first. Sessions that are running or cannot be read are left out.
std::vector<Unfinished> find_unfinished(const std::string& parent, const std::string& title,
                                        const std::string& participant);

}  // namespace dihaptic::session
