// What comes next for a participant.
#pragma once

#include <string>
#include <vector>

#include "study/roster.h"

namespace dihaptic::study {

/// A recording of one of the participant's sessions.
struct Visit {
    size_t session = 0;  ///< index in the study
    std::string folder;
    std::string started;  ///< ISO 8601
    bool complete = false;
    size_t done = 0, trials = 0;  ///< of an incomplete one
};

enum class Act { begin, resume, none };

struct Next {
    Act act = Act::none;  ///< none: all sessions are complete
    size_t session = 0;
    std::string folder;                ///< of the session to be resumed
    std::string after;                 ///< folder of the session before; empty: none
    std::string note;                  ///< about an interrupted session; may be empty
    std::vector<std::string> against;  ///< why it may not begin now; each with a figure
};

/// Hours from one ISO 8601 time with offset to another. NaN if one cannot be read.
double hours_between(const std::string& from, const std::string& to);

/// What comes next, by the study's rules; `visits` in the order of their start.
Next next_for(const StudyFile& study, const std::vector<Visit>& visits, const std::string& now);

/// Why the last attempts at a session's trials do not meet a condition, with the figure; empty if
/// they do. `trials`: its trials.csv.
std::string unmet(const Condition& condition, const std::string& trials);

}  // namespace dihaptic::study
