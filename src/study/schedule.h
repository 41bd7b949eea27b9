// Determines what comes next for a participant.
#pragma once

#include <string>
#include <vector>

#include "study/roster.h"

namespace dihaptic::study {

/// A recording of one of the participant's sessions.
struct Visit {
    size_t session = 0;  ///< index of the session in the study
    std::string folder;
    double started = 0;  ///< start time as returned by seconds_of() [s]; for a resumed session, the
                         ///< start of its first recording
    bool complete = false;
    bool running = false;         ///< whether the session is running at this moment
    bool killed = false;          ///< whether the program ended before the session did
    size_t done = 0, trials = 0;  ///< trials done and total trials, if the session is incomplete
};

enum class Act { begin, resume, none };

struct Next {
    Act act = Act::none;  ///< `none` if all sessions are complete
    size_t session = 0;
    std::string folder;                ///< folder of the session that is to be resumed
    std::string after;                 ///< folder of the previous session; empty if there is none
    std::string note;                  ///< note about an interrupted session; may be empty
    std::vector<std::string> against;  ///< reasons against starting now, each with a value
};

/// Converts an ISO 8601 time with offset, such as "2026-01-31T09:30:00+01:00", to seconds since
/// 1970. Returns NaN if the text cannot be read.
double seconds_of(const std::string& iso);

/// Returns the recording that counts as a session: the first complete recording or, if there is
/// none, the last one, provided that it has at least the fraction of its trials that the study's
/// `resuming` requires. Returns null if no recording counts.
const Visit* counted(const StudyFile& study, const std::vector<Visit>& visits, size_t session);

/// Computes a seed from words as 1 plus the CRC-32 of the words, so that each session of each
/// participant has a different seed.
uint64_t seed_of(const std::string& words);

/// Determines what comes next according to the study's rules. `visits`: recordings ordered by start
/// time. `now`: current time [s].
Next next_for(const StudyFile& study, const std::vector<Visit>& visits, double now);

/// Returns why the last attempts at a session's trials do not meet a condition, with the value
/// concerned; empty if they meet it. `trials`: path of the session's trials.csv.
std::string unmet(const Condition& condition, const std::string& trials);

/// Returns why the recording of the previous session does not meet the needs of a session, with the
/// value for each reason; empty if it meets them. `before`: folder of the previous session.
std::vector<std::string> unmet_needs(const SessionSpec& session, const std::string& before);

}  // namespace dihaptic::study
