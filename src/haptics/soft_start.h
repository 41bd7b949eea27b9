// SoftStart lets force rise gently after activation, after a pause, and when a dead-man switch is
// pressed again.
//
// Otherwise, anything around the hand at that moment (an object, a wall, a field) would strike it.
// The fraction of the force that is sent therefore rises from 0 to 1 in the time T, in the same way
// on all devices. If no force is requested from any device, nothing can strike, and the rise ends
// at once: objects touched later are felt with full force. If their force were ramped up as well,
// the hand would sink into a wall, which would then throw it out.
#pragma once

#include <algorithm>

namespace dihaptic::haptics {

class SoftStart {
  public:
    /// `duration` is the time T [s].
    explicit SoftStart(double duration) : duration_(duration) {}

    /// Returns the fraction of this tick's force that may be sent. `allowed` tells whether the
    /// dead-man switch allows force, `asked` whether any device requests a force, and `h` is the
    /// duration of the tick [s].
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

    /// Restarts after a pause.
    void restart() noexcept { elapsed_ = 0; }

  private:
    double duration_;
    double elapsed_ = 0;
};

}  // namespace dihaptic::haptics
