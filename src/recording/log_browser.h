// Finds the frame at any moment of a log, for programs that browse a session. Each chunk can be
// read on its own.
#pragma once

#include <string>
#include <vector>

#include "recording/raw_log.h"

namespace dihaptic::recording {

class LogBrowser {
  public:
    /// Throws Error if the file is not a log or contains no frame.
    explicit LogBrowser(const std::string& file);

    const LogHead& head() const { return reader_.head(); }
    /// Times of the first and the last frame [s].
    double begin() const { return begin_; }
    double end() const { return end_; }
    /// Returns the last frame at or before `time` [s], or the first frame if `time` is before it.
    /// Valid until the next call.
    const frame::Frame& at(double time);
    /// Returns the frame after the last one returned, or null at the end.
    const frame::Frame* next();

  private:
    double time_of(size_t chunk);
    size_t chunk_at(double time);
    void go_to(size_t chunk);
    void take();
    void read_on();

    RawLogReader reader_;
    RawLogReader scout_;  // reads the times at which chunks begin
    std::vector<ChunkPlace> chunks_;
    std::vector<double> times_;  // time of each chunk's first frame; NaN if not known yet [s]
    double begin_ = 0;
    double end_ = 0;
    size_t chunk_ = 0;                     // the chunk that reader_ reads next
    frame::Frame now_;                     // the last frame that at() returned
    const frame::Frame* ahead_ = nullptr;  // the frame after now_; null if there is none
};

}  // namespace dihaptic::recording
