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
    double started = 0;  ///< start, by seconds_of() [s]; of the first recording if it was resumed
    bool complete = false;
    bool running = false;         ///< the session runs at this moment
    bool killed = false;          ///< its program ended before the session did
    size_t done = 0, trials = 0;  ///< trials done, and all its trials, if it is incomplete
};

enum class Act { begin, resume, none };

struct Next {
    Act act = Act::none;  ///< none: all sessions are complete
    size_t session = 0;
    std::string folder;                ///< folder of the session to be resumed
    std::string after;                 ///< folder of the previous session; empty: none
    std::string note;                  ///< about an interrupted session; may be empty
    std::vector<std::string> against;  ///< reasons against starting now, each with a figure
};

/// Seconds since 1970 of an ISO 8601 time with offset, "2026-01-31T09:30:00+01:00". NaN if it
/// cannot be read.
double seconds_of(const std::string& iso);

/// The recording that counts as a session: the first complete one; otherwise the last, if as many
/// of its trials are done as the study's `resuming` asks for. Null: none.
const Visit* counted(const StudyFile& study, const std::vector<Visit>& visits, size_t session);

/// A seed made from words, so that each participant's sessions have seeds of their own: 1 plus the
/// words' CRC-32.
uint64_t seed_of(const std::string& words);

/// What comes next, by the study's rules; `visits` in the order of their start. `now`: [s].
Next next_for(const StudyFile& study, const std::vector<Visit>& visits, double now);

/// Why the last attempts at a session's trials do not meet a condition, with the figure; empty if
/// they do. `trials`: its trials.csv.
std::string unmet(const Condition& condition, const std::string& trials);

/// Why the recording of the previous session does not meet the needs of a session, each with a
/// figure; none if it does. `before`: its folder.
std::vector<std::string> unmet_needs(const SessionSpec& session, const std::string& before);

}  // namespace dihaptic::study
