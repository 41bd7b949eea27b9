// Measures the progress of a running session: how fast its time passes compared with the clock on
// the wall, and how far it has come since it was first looked at.
#pragma once

#include <QElapsedTimer>
#include <optional>

#include "session_progress.h"

namespace dihaptic::gui {

class ProgressMeter {
  public:
    /// A session begins. `pace`: the ratio of session time to wall time that is expected until it
    /// has been measured; 0 for as fast as possible.
    void begin(double pace);
    /// The progress in a new frame; the arguments are those of progress_of(). While the session is
    /// paused, time stands still.
    SessionProgress of(const session::Plan& plan, const frame::Frame& frame, double done,
                       bool paused);

  private:
    void follow_pace(double now, bool paused);

    std::optional<ProgressStart> start_;  // unset before the session's first frame
    double pace_ = 1;                     // ratio of session time to wall time, as measured
    double from_ = 0;                     // session time at which since_ was started [s]
    QElapsedTimer since_;                 // invalid while time stands still
};

}  // namespace dihaptic::gui
