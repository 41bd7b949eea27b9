// Loads that shake a body in place, for benches.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "base/geometry.h"
#include "base/random.h"

namespace dihaptic::bench {

/// A force and a torque on one body: along each axis three sines of 10 to 40 Hz, so that the body
/// is shaken but approximately keeps its position. Each axis may reach `force` [N] or `torque`
/// [N*m].
class Shaking {
  public:
    Shaking(Random& random, double force, double torque) : force_(force), torque_(torque) {
        for (auto& axis : sines_) {
            for (Sine& sine : axis) {
                sine.pulsation = 2 * std::numbers::pi * random.uniform(10, 40);
                sine.phase = random.uniform(0, 2 * std::numbers::pi);
            }
        }
    }
    Vec3 force(double time) const noexcept { return force_ * at(time, 0); }
    Vec3 torque(double time) const noexcept { return torque_ * at(time, 3); }

  private:
    struct Sine {
        double pulsation = 0;
        double phase = 0;
    };
    Vec3 at(double time, size_t first_axis) const noexcept {
        Vec3 out = Vec3::Zero();
        for (size_t axis = 0; axis < 3; ++axis) {
            for (const Sine& sine : sines_[first_axis + axis]) {
                out[static_cast<Eigen::Index>(axis)] +=
                    std::sin(sine.pulsation * time + sine.phase) / 3;
            }
        }
        return out;
    }
    double force_;
    double torque_;
    std::array<std::array<Sine, 3>, 6> sines_;
};

}  // namespace dihaptic::bench
