// Adaptation to rotations of the display, by the two-rate model (model/adaptation.h), in space:
// states and errors are rotation vectors. The fast process is one state for all directions, like a
// strategy. The slow process is learned by direction, and generalises by a Gaussian of the angle
// between target directions. It is stored as a sum over the directions d_m in which it was taught,
//
//     slow(d) = sum over m of s_m g(angle(d, d_m)),    g(a) = exp(-a^2 / (2 w^2))
//
// and a reach toward d with the error e does s_m <- A s_m for all m, then s <- s + B e at d. This
// equals a state x <- A x + B g e for every direction.
#pragma once

#include <array>

#include "base/geometry.h"
#include "model/adaptation.h"

namespace dihaptic::person {

class RotationMemory {
  public:
    /// `width`: w [rad].
    RotationMemory(const model::TwoRate& rates, double width) : rates_(rates), width_(width) {}

    /// Rotation vector by which the person expects a reach toward the unit vector d to be shown
    /// turned [rad].
    Vec3 expected(const Vec3& d) const noexcept;
    /// Magnitude of what both processes have learned there: |fast| + |slow(d)| [rad].
    double learned(const Vec3& d) const noexcept {
        return fast_.norm() + (expected(d) - fast_).norm();
    }
    /// Learns from a reach that is over. `error`: rotation vector from the target's direction to
    /// that in which the hand was seen to go [rad].
    void learn(const Vec3& d, const Vec3& error) noexcept;

  private:
    struct Taught {
        Vec3 d = Vec3::UnitX();
        Vec3 slow = Vec3::Zero();
    };
    // most directions: once they are used up, the nearest is taught
    static constexpr size_t kMost = 64;
    model::TwoRate rates_;
    double width_;
    Vec3 fast_ = Vec3::Zero();
    std::array<Taught, kMost> taught_;
    size_t count_ = 0;
};

}  // namespace dihaptic::person
