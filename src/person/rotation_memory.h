// Adaptation to rotations of what is seen, by the two-rate model (model/adaptation.h), in space:
// states and errors are rotation vectors. The fast process is one for all directions, as a strategy
// is. The slow one is learned where it was taught and generalises by a Gaussian of the angle
// between target directions. It is kept as what was taught where,
//
//     slow(d) = sum over m of s_m g(angle(d, d_m)),    g(a) = exp(-a^2 / (2 w^2))
//
// and each reach, toward d with the error e, does s_m <- A s_m for all, s <- s + B e at d: the same
// as a state A x + B g e for each direction there is.
#pragma once

#include <array>

#include "base/geometry.h"
#include "model/adaptation.h"

namespace dihaptic::person {

class RotationMemory {
  public:
    /// `width`: w [rad].
    RotationMemory(const model::TwoRate& rates, double width) : rates_(rates), width_(width) {}

    /// Rotation vector that a person expects what is seen to be turned by, for a target in
    /// direction d; unit [rad].
    Vec3 expected(const Vec3& d) const noexcept;
    /// How much both processes have learned there, each by its size: |fast| + |slow(d)| [rad].
    double learned(const Vec3& d) const noexcept {
        return fast_.norm() + (expected(d) - fast_).norm();
    }
    /// The reach is over. `error`: rotation vector from where the target was to where the hand was
    /// seen to go [rad].
    void learn(const Vec3& d, const Vec3& error) noexcept;

  private:
    struct Taught {
        Vec3 d = Vec3::UnitX();
        Vec3 slow = Vec3::Zero();
    };
    static constexpr size_t kMost = 64;  // directions: beyond, what was taught near is taught on
    model::TwoRate rates_;
    double width_;
    Vec3 fast_ = Vec3::Zero();
    std::array<Taught, kMost> taught_;
    size_t count_ = 0;
};

}  // namespace dihaptic::person
