// Adaptation to rotations of the display in space, by the two-rate model (model/adaptation.h).
// States and errors are rotation vectors. The fast process has one state for all directions, like a
// strategy. The slow process learns by direction (direction_memory.h).
#pragma once

#include "person/direction_memory.h"

namespace dihaptic::person {

class RotationMemory {
  public:
    /// `width`: generalisation width of the slow process [rad].
    RotationMemory(const model::TwoRate& rates, double width)
        : rate_(rates.fast), slow_(rates.slow, width) {}

    /// The rotation vector by which the person expects the display to turn a reach toward the unit
    /// vector d [rad].
    Vec3 expected(const Vec3& d) const noexcept { return slow_.added_to(fast_, d); }
    /// How much both processes have learned for the direction d: |fast| + |slow(d)| [rad].
    double learned(const Vec3& d) const noexcept {
        return fast_.norm() + (expected(d) - fast_).norm();
    }
    /// Updates the memory after a completed reach. `error`: rotation vector from the direction of
    /// the target to the direction in which the hand was seen to move [rad].
    void learn(const Vec3& d, const Vec3& error) noexcept {
        fast_ = rate_.retention * fast_ + rate_.learning * error;
        slow_.learn(d, error);
    }
    /// Applies the effect of a night of sleep (learned.h).
    void sleep() noexcept { fast_.setZero(); }

  private:
    model::SingleRate rate_;
    Vec3 fast_ = Vec3::Zero();
    DirectionMemory slow_;
};

}  // namespace dihaptic::person
