// What a simulated person feels of the own hand: where it is, how it moves, how far it is open, and
// how hard it is pressed.
#pragma once

#include <vector>

#include "frame/frame.h"
#include "hand/places.h"
#include "person/past.h"

namespace dihaptic::person {

class FeltHand {
  public:
    /// The hand's fingers are at `places`, the first of them being the frame's finger `first`.
    /// `remembered`: time for which velocities are remembered [s]. `tick`: time between Frames [s].
    FeltHand(size_t first, std::vector<hand::FingerPlace> places, double remembered, double tick)
        : first_(first), places_(std::move(places)), velocities_(remembered, tick) {}

    void restart() noexcept;
    void feel(const frame::Frame& frame, double now, double tick) noexcept;

    /// Middle of the handles [m].
    const Vec3& centre() const noexcept { return centre_; }
    /// Velocity of the middle of the handles [m/s].
    const Vec3& velocity() const noexcept { return velocity_; }
    const Vec3& velocity_before(double delay) const noexcept { return velocities_.before(delay); }
    /// Half the aperture of the handles [m].
    double half_aperture() const noexcept { return half_; }
    /// Force on a finger, smoothed like the stiffness that it determines [N].
    double force() const noexcept { return force_; }
    /// Last time when the hand was felt to move [s].
    double moved_at() const noexcept { return moved_at_; }

    size_t first() const noexcept { return first_; }
    const std::vector<hand::FingerPlace>& places() const noexcept { return places_; }
    double fingers() const noexcept { return static_cast<double>(places_.size()); }

  private:
    size_t first_;
    std::vector<hand::FingerPlace> places_;
    Past<Vec3> velocities_;
    Vec3 centre_ = Vec3::Zero();
    Vec3 velocity_ = Vec3::Zero();
    double half_ = 0;
    double force_ = 0;
    double moved_at_ = 0;
};

}  // namespace dihaptic::person
