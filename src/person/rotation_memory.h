// Adaptation to rotations of the display, by the two-rate model (model/adaptation.h), in space:
// states and errors are rotation vectors. The fast process is one state for all directions, like a
// strategy. The slow process is learned by direction (direction_memory.h).
#pragma once

#include "person/direction_memory.h"

namespace dihaptic::person {

class RotationMemory {
  public:
    /// `width`: width of generalisation of the slow process [rad].
    RotationMemory(const model::TwoRate& rates, double width)
        : rate_(rates.fast), slow_(rates.slow, width) {}

    /// Rotation vector of the displayed turn that the person expects in a reach toward the unit
    /// vector d [rad].
    Vec3 expected(const Vec3& d) const noexcept { return slow_.added_to(fast_, d); }
    /// Magnitude of the learning of both processes for the direction d: |fast| + |slow(d)| [rad].
    double learned(const Vec3& d) const noexcept {
        return fast_.norm() + (expected(d) - fast_).norm();
    }
    /// Learns from a completed reach. `error`: rotation vector from the target's direction to the
    /// direction in which the hand was seen to move [rad].
    void learn(const Vec3& d, const Vec3& error) noexcept {
        fast_ = rate_.retention * fast_ + rate_.learning * error;
        slow_.learn(d, error);
    }
    /// Applies the effect of a night's sleep (learned.h).
    void sleep() noexcept { fast_.setZero(); }

  private:
    model::SingleRate rate_;
    Vec3 fast_ = Vec3::Zero();
    DirectionMemory slow_;
};

}  // namespace dihaptic::person
