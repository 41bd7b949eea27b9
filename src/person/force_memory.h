// Adaptation to forces that push the hand as it moves, by the two-rate model (model/adaptation.h).
// A person expects a movement with speed s along the unit vector d to be pushed by the force
//
//     f = s F(d)        F = F_fast + F_slow                [N], [N*s/m]
//
// and presses against this force. F is a vector in space, so that fields across the movement (curl)
// and fields along the movement (viscous) are learned alike; both processes learn by direction
// (direction_memory.h). The teaching signal is the difference between the felt push (strain.h) and
// the expected push, per speed:
//
//     e = sum s f_felt / sum s^2 - F(d)        over the ticks of a reach
//
// A push that comes late is also expected late: s is the speed one lag ago. The lag is learned as
// the time by which the middle of the felt push comes after the middle of that speed. People whose
// field came 70 ms late pressed 67 ms after their speed in channels, and 10 ms in a field without
// delay (Avraham et al. 2017, own evaluation).
#pragma once

#include <algorithm>

#include "person/direction_memory.h"

namespace dihaptic::person {

class ForceMemory {
  public:
    /// `width`: generalisation width of both processes [rad].
    ForceMemory(const model::TwoRate& rates, double width)
        : fast_(rates.fast, width), slow_(rates.slow, width) {}

    /// F(d) [N*s/m].
    Vec3 expected(const Vec3& d) const noexcept {
        return slow_.added_to(fast_.added_to(Vec3::Zero(), d), d);
    }
    /// Updates the memory after a completed reach. `error`: e [N*s/m].
    void learn(const Vec3& d, const Vec3& error) noexcept {
        fast_.learn(d, error);
        slow_.learn(d, error);
    }
    /// Time by which the expected push follows the speed [s].
    double lag() const noexcept { return lag_; }
    /// Updates the lag. `later`: time by which the felt push came after the expected one [s].
    void learn_lag(double later) noexcept {
        lag_ = std::clamp(lag_ + kLagLearning * later, 0.0, kLongestLag);
    }
    /// Applies the effect of a night of sleep (learned.h).
    void sleep() noexcept { fast_.forget(); }
    /// Whether nothing has been learned.
    bool empty() const noexcept { return fast_.empty() && slow_.empty(); }

    static constexpr double kLongestLag = 0.2;  ///< [s]

  private:
    static constexpr double kLagLearning = 0.1;  // share of an error of the lag; an assumption
    DirectionMemory fast_;
    DirectionMemory slow_;
    double lag_ = 0;
};

}  // namespace dihaptic::person
