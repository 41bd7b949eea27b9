// Describes how complete a session's log is: which ticks are missing, where and why, and what
// foreign data the log contains. The description is collected while the log is read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/clock.h"

namespace dihaptic::recording {

/// Missing ticks between two ticks that are present.
struct Gap {
    int64_t first = 0;  ///< tick
    int64_t ticks = 0;
    Time before{0};             ///< time of the last tick before the gap, or of the session's start
    Time after{0};              ///< time of the first tick after the gap
    int64_t damaged_bytes = 0;  ///< number of damaged bytes in the gap
    int64_t chunks = 0;         ///< number of missing chunks; if this and damaged_bytes are 0, the
                                ///< ticks were never written
};

/// Data found in a log where the next part of its session should be.
struct Stray {
    enum class Kind {
        moved,      ///< chunks stored after later ones; used in order of their numbers
        doubled,    ///< chunks that had already been read; ignored
        foreign,    ///< chunks of another session; ignored
        after_end,  ///< bytes after the end mark; ignored
        no_chunk,   ///< bytes between two consecutive chunks; ignored
        no_frame,   ///< chunks that contain bytes that are not a frame; used up to those bytes
        backwards,  ///< frames that are not later than the previous one; ignored
    };
    Kind kind = Kind::foreign;
    int64_t count = 0;  ///< number of chunks or frames
    int64_t bytes = 0;
    Time from{0};  ///< time of the tick before the first of these data
};

struct LogHealth {
    int64_t frames = 0;      ///< number of frames read, one per tick
    int64_t last_tick = -1;  ///< the last tick in the log
    Time last_time{0};       ///< its time
    std::vector<Gap> gaps;   ///< gaps before the last tick
    int64_t left_out = 0;    ///< number of ticks that the servo skipped because it was late
    bool complete = false;   ///< whether the log has its end mark
    int64_t written = -1;  ///< number of frames stated by the end mark; -1 if there is no end mark
    std::vector<Stray> strays;  ///< at most one of each kind
    int64_t tail_bytes = 0;     ///< bytes after the last tick that belong to no complete chunk
    bool unfinished = false;    ///< whether the tail begins an incomplete chunk, not a damaged one
    int64_t tail_ticks = 0;     ///< approximate number of ticks in the tail
    int64_t tail_chunks = 0;    ///< number of chunks missing before the end mark
    /// For a log of another version: the fields that frames have now but lacked then, and vice
    /// versa.
    std::vector<std::string> not_recorded;
    std::vector<std::string> passed_over;

    void note(Stray::Kind kind, int64_t count, int64_t bytes);
    /// Number of missing ticks before the last one that is present.
    int64_t missing() const;
    /// Whether the log differs from that of a session that ended properly: the log is damaged,
    /// lacks its end, or contains foreign data. `ticks` is the number of ticks in the session, or 0
    /// if unknown.
    bool damaged(int64_t ticks) const;
};

/// Describes each gap, all foreign data, and the end of the log, in sentences. `ticks` is as in
/// damaged(); `planned` is the planned length of the session [s], or 0 if unknown.
std::vector<std::string> describe(const LogHealth& health, int64_t ticks, double planned);
/// Describes in sentences how a log of another version differs; empty for a log of this version.
std::vector<std::string> describe_version(const LogHealth& health);
/// Describes in a sentence how many ticks the servo skipped; "" if none. `period` is the length of
/// a tick [s].
std::string describe_left_out(int64_t ticks, double period);

}  // namespace dihaptic::recording
