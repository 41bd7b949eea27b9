// Onset makes the first touch soft: proxy, spring and damper together are rendered at a fraction s
// of their settings. s grows from kFirstShare to 1 over the onset's time while the proxy touches a
// body, and falls at the same rate while it does not. The force is s times that of a spring whose
// stretch has just started, so it has no step on touching, leaving or touching again.
#pragma once

#include <algorithm>

namespace dihaptic::haptics {

class Onset {
  public:
    static constexpr double kFirstShare = 0.1;

    /// `time`: from first touch to full stiffness [s]; 0: at once.
    explicit Onset(double time) : time_(time), share_(time > 0 ? kFirstShare : 1) {}

    /// The fraction s in this tick, 0 to 1.
    double share() const noexcept { return share_; }
    /// Last call in a tick of h [s].
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
