#include "haptics/heating.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dihaptic::haptics {

Heating::Heating(double peak, double continuous, double time)
    : limits_(std::isfinite(peak) && continuous < peak),
      peak_(peak),
      continuous_(continuous),
      time_(time) {}

double Heating::most_force() const noexcept {
    if (!limits_) return std::numeric_limits<double>::infinity();
    const double held = continuous_ * continuous_;
    const double cold = std::max(0.0, 1 - mean_square_ / held);
    return std::sqrt(held + (peak_ * peak_ - held) * cold);
}

void Heating::add(const Vec3& force, double h) noexcept {
    if (limits_) mean_square_ += -std::expm1(-h / time_) * (force.squaredNorm() - mean_square_);
}

}  // namespace dihaptic::haptics
