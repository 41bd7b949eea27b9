// Adaptation to forces that push the hand as it moves, by the two-rate model (model/adaptation.h).
// A person expects that a movement along d (unit) with the speed s is pushed by the force
//
//     f = s F(d)        F = F_fast + F_slow                [N], [N*s/m]
//
// and presses against it. F is a vector in space, so that fields across the movement (curl) and
// along it (viscous) are learned alike; both processes are learned by direction
// (direction_memory.h). The teaching signal is the felt push (strain.h) per speed, beyond the
// expected one:
//
//     e = sum s f_felt / sum s^2 - F(d)        over the ticks of a reach
#pragma once

#include "person/direction_memory.h"

namespace dihaptic::person {

class ForceMemory {
  public:
    /// `width`: width of generalisation of both processes [rad].
    ForceMemory(const model::TwoRate& rates, double width)
        : fast_(rates.fast, width), slow_(rates.slow, width) {}

    /// F(d) [N*s/m].
    Vec3 expected(const Vec3& d) const noexcept {
        return slow_.added_to(fast_.added_to(Vec3::Zero(), d), d);
    }
    /// Learns from a completed reach. `error`: e [N*s/m].
    void learn(const Vec3& d, const Vec3& error) noexcept {
        fast_.learn(d, error);
        slow_.learn(d, error);
    }
    /// Applies the effect of a night's sleep (learned.h).
    void sleep() noexcept { fast_.forget(); }
    /// Whether nothing has been learned.
    bool empty() const noexcept { return fast_.empty() && slow_.empty(); }

  private:
    DirectionMemory fast_;
    DirectionMemory slow_;
};

}  // namespace dihaptic::person
