// Onset makes the first touch soft: the proxy, the spring and the damper are all rendered at a
// fraction s of their settings, which grows from kFirstShare to 1 over the onset's time while the
// proxy touches a body, and falls at the same rate while it does not. The force is s times that of
// a spring whose stretch has just started, so it does not jump when the proxy touches a body,
// leaves it or touches it again.
#pragma once

#include <algorithm>

namespace dihaptic::haptics {

class Onset {
  public:
    static constexpr double kFirstShare = 0.1;

    /// `time` is the time from first touch to full stiffness [s]; if 0, full stiffness applies at
    /// once.
    explicit Onset(double time) : time_(time), share_(time > 0 ? kFirstShare : 1) {}

    /// The fraction s in this tick, between 0 and 1.
    double share() const noexcept { return share_; }
    /// Must be called last in a tick of h [s].
    void advance(bool touching, double h) noexcept {
        if (time_ <= 0) return;
        const double way = (1 - kFirstShare) * h / time_;
        share_ = std::clamp(share_ + (touching ? way : -way), kFirstShare, 1.0);
    }

  private:
    double time_;
    double share_;
};

}  // namespace dihaptic::haptics
