// The state of one adaptation process (model/adaptation.h) as a function of the direction of a
// movement in space: each direction has a vector, which generalises to other directions by a
// Gaussian of the angle between them. The state is stored as a sum over the directions d_m in which
// training took place:
//
//     x(d) = sum over m of x_m g(angle(d, d_m)),    g(a) = exp(-a^2 / (2 w^2))
//
// A movement along d with the error e updates x_m <- A x_m for all m, then x <- x + B e at d. This
// is equivalent to a state x <- A x + B g e for every direction.
#pragma once

#include <array>

#include "base/geometry.h"
#include "model/adaptation.h"

namespace dihaptic::person {

class DirectionMemory {
  public:
    /// `width`: the width w of the Gaussian [rad].
    DirectionMemory(const model::SingleRate& rate, double width) : rate_(rate), width_(width) {}

    /// Returns `sum` + x(d) for a unit vector d.
    Vec3 added_to(Vec3 sum, const Vec3& d) const noexcept;
    void learn(const Vec3& d, const Vec3& error) noexcept;
    bool empty() const noexcept { return count_ == 0; }
    void forget() noexcept { count_ = 0; }

  private:
    struct Taught {
        Vec3 d = Vec3::UnitX();
        Vec3 x = Vec3::Zero();
    };
    // largest number of stored directions; when all are used, the nearest is trained
    static constexpr size_t kMost = 64;
    model::SingleRate rate_;
    double width_;
    std::array<Taught, kMost> taught_;
    size_t count_ = 0;
};

}  // namespace dihaptic::person
