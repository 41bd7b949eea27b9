// Chatter detects a force on a hand that alternates from tick to tick. Neither a hand nor a contact
// produces such a force, but a spring that is too stiff for the time step does.
//
//     d = |f - 2 f_old + f_older| / 4
//
// is the amplitude of the alternating part; a step in f makes it non-zero for two ticks, a slope
// never does. The force chatters when d has been above kChatter for more than the fraction
// kChattering of the last kChatterTime, as measured by a first-order low-pass filter.
#pragma once

#include <algorithm>

#include "base/geometry.h"

namespace dihaptic::haptics {

/// Amplitude that feels like a blow in each tick [N]. Encoder steps of 0.03 mm at 8000 N/m cause
/// half of this amplitude.
constexpr double kChatter = 0.25;
constexpr double kChatterTime = 0.03;  // [s]
constexpr double kChattering = 0.8;    // reached 48 ms after chatter starts

class Chatter {
  public:
    /// Adds a tick of h [s] in which `force` was sent to the device.
    void add(const Vec3& force, double h) noexcept {
        const double d = (force - 2 * last_ + older_).norm() / 4;
        share_ += std::min(1.0, h / kChatterTime) * ((d > kChatter ? 1 : 0) - share_);
        amplitude_ = d;
        older_ = last_;
        last_ = force;
    }
    /// Amplitude of the force if it chatters, otherwise 0 [N].
    double amplitude() const noexcept { return share_ > kChattering ? amplitude_ : 0; }

  private:
    Vec3 last_ = Vec3::Zero();
    Vec3 older_ = Vec3::Zero();
    double share_ = 0;
    double amplitude_ = 0;
};

}  // namespace dihaptic::haptics
