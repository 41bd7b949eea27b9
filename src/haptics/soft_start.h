// SoftStart lets force come on gently: after activation and a pause, and when a dead-man switch is
// pressed again.
//
// Anything that a hand is inside of at that moment (an object, a wall, a field) would strike it.
// The share of the force that is sent therefore rises from 0 to 1 in the time T, on all devices
// alike. If no device is asked for a force, nothing can strike, and the rise is over at once: what
// is touched later is felt as it is. If that were ramped as well, a hand would sink into a wall,
// which would then throw it out.
#pragma once

#include <algorithm>

namespace dihaptic::haptics {

class SoftStart {
  public:
    /// `duration`: T [s].
    explicit SoftStart(double duration) : duration_(duration) {}

    /// The share of this tick's force that may be sent. `allowed`: by the dead-man switch; `asked`:
    /// whether some device is asked for a force; `h`: duration of the tick [s].
    double share(bool allowed, bool asked, double h) noexcept {
        if (!allowed) {
            elapsed_ = 0;
            return 0;
        }
        if (!asked) elapsed_ = duration_;
        const double share = elapsed_ < duration_ ? elapsed_ / duration_ : 1;
        elapsed_ = std::min(duration_, elapsed_ + h);
        return share;
    }

    /// Starts again after a pause.
    void restart() noexcept { elapsed_ = 0; }

  private:
    double duration_;
    double elapsed_ = 0;
};

}  // namespace dihaptic::haptics
