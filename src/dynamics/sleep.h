// Decides when bodies sleep. A body is called quiet while it hardly moves. Bodies that touch each
// other fall asleep together, once each of them has been quiet for a while and no finger touches
// any of them. They wake together, in the step in which an awake body touches one of them or a load
// is applied.
//
// The speed limits are far below what people can perceive. A sliding block that slows down passes
// through them within milliseconds, while falling asleep takes half a second, so a sliding body is
// never frozen.
#pragma once

#include <span>
#include <vector>

#include "base/geometry.h"
#include "dynamics/groups.h"

namespace dihaptic::dynamics {

constexpr double kQuietSpeed = 2e-4;         // [m/s]
constexpr double kQuietAngularSpeed = 1e-2;  // [rad/s]
constexpr double kQuietTime = 0.5;           // [s]

class SleepKeeper {
  public:
    explicit SleepKeeper(size_t bodies) : quiet_(bodies, 0.0), group_quiet_(bodies, true) {}

    /// Marks a body as not quiet, whatever its speed.
    void stir(size_t body) noexcept { quiet_[body] = 0; }
    /// Updates the quiet time of an awake body after one step.
    void observe(size_t body, const Vec3& v, const Vec3& w, double h) noexcept {
        const bool quiet = v.squaredNorm() < kQuietSpeed * kQuietSpeed &&
                           w.squaredNorm() < kQuietAngularSpeed * kQuietAngularSpeed;
        quiet_[body] = quiet ? quiet_[body] + h : 0.0;
    }
    /// Checks all groups. Afterwards, may_sleep() tells for each awake body whether it may sleep.
    void judge(std::span<const size_t> awake, Groups& groups) noexcept {
        for (const size_t body : awake) group_quiet_[groups.of(body)] = true;
        for (const size_t body : awake) {
            if (quiet_[body] < kQuietTime) group_quiet_[groups.of(body)] = false;
        }
    }
    bool may_sleep(size_t body, Groups& groups) const noexcept {
        return group_quiet_[groups.of(body)] != 0;
    }

  private:
    std::vector<double> quiet_;      // time for which each body has been quiet [s]
    std::vector<char> group_quiet_;  // indexed by the body that represents a group
};

}  // namespace dihaptic::dynamics
