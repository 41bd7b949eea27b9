#include "seen_display.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::gui {

bool SeenDisplay::set_head(const outlets::HeadPose& head) {
    const bool moved = !head_ || head_->eyes != head.eyes || head_->along != head.along;
    head_ = head;
    return moved && display_ && display_->eyes.tracked;
}

display::Display SeenDisplay::now() {
    display::Display out = *display_;
    forget_head();
    if (out.eyes.tracked && head_) {
        out.eyes.position = head_->eyes;
        out.eyes.along = head_->along;
        if (out.faces(out.eyes)) {
            shown_to_ = head_;
        } else {
            out.eyes = display_->eyes;
        }
    }
    if (out.stereo == display::Stereo::in_turn) out.eyes.position = out.eyes.of(right_eye_);
    return out;
}

bool SeenDisplay::take_turns(double refresh_rate) {
    if (!display_ || display_->stereo != display::Stereo::in_turn) return false;
    const double periods = 1e-9 * static_cast<double>(since_swap_.nsecsElapsed()) * refresh_rate;
    const bool timed = since_swap_.isValid() && std::isfinite(periods);
    since_swap_.start();
    if (!timed || std::lround(std::max(1.0, periods)) % 2 == 1) right_eye_ = !right_eye_;
    return true;
}

}  // namespace dihaptic::gui
