// What of a session its log holds: which ticks are missing, where, and why. Found while the log is
// read.
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
    int64_t damaged_bytes = 0;  ///< of the log; 0: they were never written
};

struct LogHealth {
    int64_t frames = 0;       ///< read: one a tick
    int64_t last_tick = -1;   ///< the last that is there
    Time last_time{0};        ///< its time
    std::vector<Gap> gaps;    ///< before the last tick
    int64_t left_out = 0;     ///< ticks that never were: the servo was late, and skipped them
    bool complete = false;    ///< the end mark is there
    int64_t tail_bytes = 0;   ///< in no whole chunk, after the last tick
    bool unfinished = false;  ///< the tail is the beginning of a chunk, not a damaged one
    int64_t tail_ticks = 0;   ///< in the tail, about

    /// Between the first tick and the last that is there.
    int64_t missing() const;
    /// Damaged, or without its end: other than a session that ended in order leaves. `ticks`: how
    /// many that session had; 0: not known.
    bool damaged(int64_t ticks) const;
};

/// In sentences: each gap, the end, and what never was. `ticks` as in damaged(); `planned`: how
/// long the session was to be [s]; 0: not known.
std::vector<std::string> describe(const LogHealth& health, int64_t ticks, double planned);
/// Ticks that the servo left out, in a sentence; "" without any. `period`: of a tick [s].
std::string describe_left_out(int64_t ticks, double period);

}  // namespace dihaptic::recording
