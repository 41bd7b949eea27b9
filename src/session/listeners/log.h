// The log of a session: its recorder or, if the caller reads the frames, the caller's sink.
#pragma once

#include <atomic>
#include <exception>
#include <optional>

#include "recording/recorder.h"
#include "session/listeners/listener.h"

namespace dihaptic::session {

class Log : public Listener {
  public:
    /// Throws Error if the log file cannot be created.
    explicit Log(const Opening& opening);

    void take(const frame::Frame& frame) noexcept override;
    /// True once a frame could not be written.
    bool ends() const noexcept override { return failed_ || (recorder_ && recorder_->failed()); }
    /// Throws Error when the log could not be written to its end.
    std::vector<std::string> finish() override;

    /// Frames that were written, or read by the sink.
    int64_t frames() const { return frames_ - dropped(); }
    /// Frames that the recorder could not accept.
    int64_t dropped() const { return recorder_ ? recorder_->dropped() : 0; }

  private:
    std::optional<recording::Recorder> recorder_;
    frame::FrameSink sink_;  // used if there is no recorder
    int64_t frames_ = 0;
    std::atomic<bool> failed_{false};
    std::exception_ptr error_;  // error on the virtual clock, where the tick itself writes frames
};

}  // namespace dihaptic::session
