// Finds a participant's next session in a study, for the command line and for the window.
#pragma once

#include <functional>
#include <string>

#include "recording/session.h"
#include "session/study_session.h"

namespace dihaptic::app {

/// What a study says about a participant's next session.
struct StudyTurn {
    std::string experiment;  ///< file
    std::string out;         ///< folder of the new recording
    std::string resume;      ///< folder of the interrupted session to resume; empty if none
    recording::Participant participant;
    recording::InStudy in_study;
    uint64_t seed = 1;         ///< differs between participants and sessions
    uint64_t person_seed = 1;  ///< for drawing the simulated person; the same in all sessions

    /// Notes the start of the session in the study's log.
    void log_begin() const;

    study::StudyFile study;
    bool simulated = false;
};

/// Finds the next session of a participant, or of the simulated person who takes the participant's
/// place. `despite`: reason for starting a session against the study's rules, which is written to
/// the log; if empty, such a session is refused. Throws Error when no session may begin now (the
/// message gives the numbers that rule it out), or when the study's files have changed. `tell`:
/// called with each line for the operator.
StudyTurn study_turn(const std::string& file, const std::string& participant,
                     const std::string& despite, bool simulated,
                     const std::function<void(const std::string& line)>& tell);

}  // namespace dihaptic::app
