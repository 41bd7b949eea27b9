// Adaptation to rotations of the display in space, by the two-rate model (model/adaptation.h).
// States and errors are rotation vectors. The fast process has one state for all directions, like a
// strategy. The slow process learns by direction (direction_memory.h).
//
// Each process learns from an error e as from the smaller one l tanh(|e| / l), where l is its
// limit: people learn hardly more from an error of 60 degrees than from one of 30 (README.md).
#pragma once

#include <cmath>

#include "person/direction_memory.h"

namespace dihaptic::person {

/// The size of an error above which a process learns hardly more [rad]; 0 for none.
struct ErrorLimits {
    double fast = 0;
    double slow = 0;
};

/// The error from which a process with this limit learns.
inline Vec3 limited(const Vec3& error, double limit) noexcept {
    const double size = error.norm();
    if (limit <= 0 || size < 1e-12) return error;
    return limit * std::tanh(size / limit) / size * error;
}

class RotationMemory {
  public:
    /// `width`: generalisation width of the slow process [rad].
    RotationMemory(const model::TwoRate& rates, double width, const ErrorLimits& limits)
        : rate_(rates.fast), slow_(rates.slow, width), limits_(limits) {}

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
        fast_ = rate_.retention * fast_ + rate_.learning * limited(error, limits_.fast);
        slow_.learn(d, limited(error, limits_.slow));
    }
    /// Applies the effect of a night of sleep (learned.h).
    void sleep() noexcept { fast_.setZero(); }

  private:
    model::SingleRate rate_;
    Vec3 fast_ = Vec3::Zero();
    DirectionMemory slow_;
    ErrorLimits limits_;
};

}  // namespace dihaptic::person
