// What of a session its log holds: which ticks are missing, where, and why; and what stands in it
// that does not belong there. Found while the log is read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/clock.h"

namespace dihaptic::recording {

/// Ticks that are missing between two that are there.
struct Gap {
    int64_t first = 0;  ///< tick
    int64_t ticks = 0;
    Time before{0};  ///< of the last tick before; of the session's start if there is none
    Time after{0};   ///< of the first tick after
    int64_t damaged_bytes = 0;  ///< of the log, there
    int64_t chunks = 0;         ///< of the log, that are gone; both 0: they were never written
};

/// What stands in a log and is not the next part of its session.
struct Stray {
    enum class Kind {
        moved,      ///< chunks behind later ones; used in the order of their numbers
        doubled,    ///< chunks that are there before; left out
        foreign,    ///< chunks of another session; left out
        after_end,  ///< bytes behind the end mark; left out
        no_chunk,   ///< bytes between two chunks of which none is missing; left out
        no_frame,   ///< chunks with what is no frame; used up to that
        backwards,  ///< frames that are no later than the one before; left out
    };
    Kind kind = Kind::foreign;
    int64_t count = 0;  ///< chunks, or frames
    int64_t bytes = 0;
    Time from{0};  ///< of the tick before the first of them
};

struct LogHealth {
    int64_t frames = 0;         ///< read: one a tick
    int64_t last_tick = -1;     ///< the last that is there
    Time last_time{0};          ///< its time
    std::vector<Gap> gaps;      ///< before the last tick
    int64_t left_out = 0;       ///< ticks that never were: the servo was late, and skipped them
    bool complete = false;      ///< the end mark is there
    int64_t written = -1;       ///< frames that it tells of; -1: it is not there
    std::vector<Stray> strays;  ///< one of a kind
    int64_t tail_bytes = 0;     ///< in no whole chunk, after the last tick
    bool unfinished = false;    ///< the tail is the beginning of a chunk, not a damaged one
    int64_t tail_ticks = 0;     ///< in the tail, about
    int64_t tail_chunks = 0;    ///< gone between the last tick and the end mark
    /// Of a log of another version: what frames have today and had not then, and the reverse.
    std::vector<std::string> not_recorded;
    std::vector<std::string> passed_over;

    void note(Stray::Kind kind, int64_t count, int64_t bytes);
    /// Between the first tick and the last that is there.
    int64_t missing() const;
    /// Damaged, without its end, or not what one session wrote: other than a session that ended in
    /// order leaves. `ticks`: how many that session had; 0: not known.
    bool damaged(int64_t ticks) const;
};

/// In sentences: each gap, what does not belong there, and the end. `ticks` as in damaged();
/// `planned`: how long the session was to be [s]; 0: not known.
std::vector<std::string> describe(const LogHealth& health, int64_t ticks, double planned);
/// How a log of another version differs, in sentences; none of one of this version.
std::vector<std::string> describe_version(const LogHealth& health);
/// Ticks that the servo left out, in a sentence; "" without any. `period`: of a tick [s].
std::string describe_left_out(int64_t ticks, double period);

}  // namespace dihaptic::recording
