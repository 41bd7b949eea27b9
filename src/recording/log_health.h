// Describes how complete a session's log is: which ticks are missing, where, and why, and which
// foreign data the log contains. The description is made while the log is read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/clock.h"

namespace dihaptic::recording {

/// Missing ticks between two that are present.
struct Gap {
    int64_t first = 0;  ///< tick
    int64_t ticks = 0;
    Time before{0};             ///< time of the last tick before the gap, or of the session's start
    Time after{0};              ///< time of the first tick after the gap
    int64_t damaged_bytes = 0;  ///< damaged bytes of the log in the gap
    int64_t chunks = 0;         ///< missing chunks; if both are 0, the ticks were never written
};

/// Data in a log that are not the next part of its session.
struct Stray {
    enum class Kind {
        moved,      ///< chunks after later ones; used in the order of their numbers
        doubled,    ///< chunks that were read before; left out
        foreign,    ///< chunks of another session; left out
        after_end,  ///< bytes after the end mark; left out
        no_chunk,   ///< bytes between two consecutive chunks; left out
        no_frame,   ///< chunks with bytes that are not a frame; used up to those bytes
        backwards,  ///< frames no later than the previous one; left out
    };
    Kind kind = Kind::foreign;
    int64_t count = 0;  ///< number of chunks, or of frames
    int64_t bytes = 0;
    Time from{0};  ///< time of the tick before the first of them
};

struct LogHealth {
    int64_t frames = 0;      ///< number of frames read: one for each tick
    int64_t last_tick = -1;  ///< the last tick in the log
    Time last_time{0};       ///< its time
    std::vector<Gap> gaps;   ///< before the last tick
    int64_t left_out = 0;    ///< number of ticks that the servo skipped, because it was late
    bool complete = false;   ///< the log has its end mark
    int64_t written = -1;  ///< number of frames that the end mark states; -1: there is no end mark
    std::vector<Stray> strays;  ///< at most one of each kind
    int64_t tail_bytes = 0;     ///< bytes after the last tick that belong to no whole chunk
    bool unfinished = false;    ///< the tail is the beginning of a chunk, not a damaged one
    int64_t tail_ticks = 0;     ///< approximate number of ticks in the tail
    int64_t tail_chunks = 0;    ///< number of chunks missing before the end mark
    /// For a log of another version: fields that frames now have but then lacked, and the reverse.
    std::vector<std::string> not_recorded;
    std::vector<std::string> passed_over;

    void note(Stray::Kind kind, int64_t count, int64_t bytes);
    /// Number of missing ticks before the last one that is present.
    int64_t missing() const;
    /// Whether the log differs from that of a session that ended properly: it is damaged, lacks its
    /// end, or has foreign parts. `ticks` is the number of ticks that the session had; 0 if that is
    /// not known.
    bool damaged(int64_t ticks) const;
};

/// Describes each gap, each foreign part, and the end, in sentences. `ticks` is as in damaged();
/// `planned` is the planned length of the session [s], 0 if that is not known.
std::vector<std::string> describe(const LogHealth& health, int64_t ticks, double planned);
/// Describes how a log of another version differs, in sentences; empty for one of this version.
std::vector<std::string> describe_version(const LogHealth& health);
/// Describes in a sentence the ticks that the servo skipped; "" if there are none. `period` is the
/// length of a tick [s].
std::string describe_left_out(int64_t ticks, double period);

}  // namespace dihaptic::recording
