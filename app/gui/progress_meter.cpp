#include "progress_meter.h"

#include <algorithm>
#include <utility>

namespace dihaptic::gui {

void ProgressMeter::begin(double pace) {
    start_.reset();
    pace_ = pace > 0 ? pace : 1;
    since_.invalidate();
}

SessionProgress ProgressMeter::of(const session::Plan& plan, const frame::Frame& frame, double done,
                                  bool paused) {
    const double now = seconds(frame.time);
    follow_pace(now, paused);
    if (!start_) start_ = ProgressStart{now, done};
    return progress_of(plan, frame, done, pace_, *start_);
}

/// Measures how fast the session's time passes, once a second.
void ProgressMeter::follow_pace(double now, bool paused) {
    if (paused) return since_.invalidate();
    if (!since_.isValid() || now < from_) {
        since_.start();
        from_ = now;
    } else if (since_.elapsed() >= 1000) {
        const double wall = static_cast<double>(since_.restart()) * 1e-3;
        pace_ = std::max(1e-3, (now - std::exchange(from_, now)) / wall);
    }
}

}  // namespace dihaptic::gui
