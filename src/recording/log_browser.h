// Finds the frame of any moment of a log, for programs that browse a session: each chunk can be
// read by itself.
#pragma once

#include <string>
#include <vector>

#include "recording/raw_log.h"

namespace dihaptic::recording {

class LogBrowser {
  public:
    /// Throws Error if the file is not a log, or has no frame.
    explicit LogBrowser(const std::string& file);

    const LogHead& head() const { return reader_.head(); }
    /// Times of the first and of the last frame [s].
    double begin() const { return begin_; }
    double end() const { return end_; }
    /// The newest frame at a time [s]; the first frame, if the time is before it. Valid until the
    /// next call.
    const frame::Frame& at(double time);
    /// The frame after the last one returned; null at the end.
    const frame::Frame* next();

  private:
    double time_of(size_t chunk);
    size_t chunk_at(double time);
    void go_to(size_t chunk);
    void take();
    void read_on();

    RawLogReader reader_;
    RawLogReader scout_;  // reads the times of chunks
    std::vector<ChunkPlace> chunks_;
    std::vector<double> times_;  // times of the chunks' first frames; NaN if not yet known [s]
    double begin_ = 0;
    double end_ = 0;
    size_t chunk_ = 0;                     // the chunk that reader_ reads next
    frame::Frame now_;                     // the last frame that at() returned
    const frame::Frame* ahead_ = nullptr;  // the frame after now_; null if there is none
};

}  // namespace dihaptic::recording
