// Watches that the force on a hand does not alternate from tick to tick: no hand and no contact
// makes it do so, but a spring that is stiffer than the step bears.
//
//     d = |f - 2 f_old + f_older| / 4
//
// is the amplitude of what alternates; a step of f has it for two ticks, a slope never. The force
// chatters when d has been above kChatter for more than kChattering of the last kChatterTime (a low
// pass of first order).
#pragma once

#include <algorithm>

#include "base/geometry.h"

namespace dihaptic::haptics {

/// An amplitude that is felt as a blow in each tick. Encoder steps of 0.03 mm at 8000 N/m have half
/// of it [N].
constexpr double kChatter = 0.25;
constexpr double kChatterTime = 0.03;  // [s]
constexpr double kChattering = 0.8;    // reached 48 ms after it began

class Chatter {
  public:
    /// Once a tick of h [s], with the force that the device is told.
    void add(const Vec3& force, double h) noexcept {
        const double d = (force - 2 * last_ + older_).norm() / 4;
        share_ += std::min(1.0, h / kChatterTime) * ((d > kChatter ? 1 : 0) - share_);
        amplitude_ = d;
        older_ = last_;
        last_ = force;
    }
    /// Amplitude of a force that chatters, or else 0 [N].
    double amplitude() const noexcept { return share_ > kChattering ? amplitude_ : 0; }

  private:
    Vec3 last_ = Vec3::Zero();
    Vec3 older_ = Vec3::Zero();
    double share_ = 0;
    double amplitude_ = 0;
};

}  // namespace dihaptic::haptics
