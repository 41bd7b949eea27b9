// Going on with a session of trials that was not finished: at the right trial, with the same
// inputs, and with what moved the hand before. A person's trials are never finished by a script.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiment/plan.h"

namespace dihaptic::session {

/// What is left of a session.
struct Rest {
    experiment::Plan plan;
    recording::SessionInfo before;  ///< of the session that it goes on with
    std::vector<Problem> warnings;  ///< of recovering, if it was killed

    /// What it goes on with, at which trial, and who moves the hand, in a line each.
    std::string describe() const;
};

/// Recovers the session first, if it was killed; `progress` is of that. Throws Error when nothing
/// is left, when it has no trials, or when what moved its hand is not known or cannot do so here.
Rest rest_of(const std::string& session, experiment::Seat seat,
             const std::function<void(double)>& progress);

/// A session whose trials are not all done.
struct Unfinished {
    std::string folder;
    std::string started;  ///< ISO 8601
    size_t done = 0;  ///< trials that were tried; 0 of one that was killed, until it is recovered
    size_t trials = 0;
    recording::MovedBy moved_by;
};

/// Sessions in the folder `parent` of that participant and experiment (title) which ended, or were
/// killed, before their trials did, and which no other session goes on with: the newest first. One
/// that runs is none of them, and neither is one that cannot be read.
std::vector<Unfinished> find_unfinished(const std::string& parent, const std::string& title,
                                        const std::string& participant);

}  // namespace dihaptic::session
