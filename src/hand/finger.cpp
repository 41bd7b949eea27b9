#include "hand/finger.h"

#include <fmt/format.h>

#include <numbers>

namespace dihaptic::hand {

Tremor::Tremor(const TremorSpec& spec, uint64_t seed, int finger) : amplitude_(spec.amplitude) {
    Random random(seed, fmt::format("tremor of finger {}", finger));
    for (int axis = 0; axis < 3; ++axis) {
        angular_frequency_[axis] = 2 * std::numbers::pi * random.uniform(spec.low, spec.high);
        phase_[axis] = 2 * std::numbers::pi * random.uniform(0, 1);
    }
}

void Tremor::add(FingerTarget& target, double t) const noexcept {
    if (amplitude_ == 0) return;
    for (int axis = 0; axis < 3; ++axis) {
        const double angle = angular_frequency_[axis] * t + phase_[axis];
        target.p_WT[axis] += amplitude_ * std::sin(angle);
        target.v_WT[axis] += amplitude_ * angular_frequency_[axis] * std::cos(angle);
    }
}

}  // namespace dihaptic::hand
