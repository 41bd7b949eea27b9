// A simulated person's grip and lift in the phases of Johansson and Westling (1984): grip force
// follows a plan that expects a weight and a friction, and touch corrects it a reflex latency
// later. README.md has the equations.
#pragma once

#include <vector>

#include "person/grip_memory.h"
#include "person/past.h"
#include "person/strokes.h"
#include "person/touch.h"

namespace dihaptic::person {

enum class GripPhase {
    open,     ///< fingers follow the aim
    preload,  ///< fingers touch and press; load force has not begun
    ready,    ///< gripped, not lifted
    load,     ///< grip and load force rise together, until the object comes off
    lifted,   ///< grip force has a peak at first, then is static
    unload,   ///< grip and load force fall together
};

class Grip {
  public:
    /// `memory`: for each body of the scene, the knowledge that its appearance suggests.
    Grip(const Traits& traits, std::vector<GripMemory> memory, double tick);

    void restart() noexcept;
    /// Sets this trial's `latency` of reflexes [s]; `strength`: grip force over the right one;
    /// `misfelt`: felt over true friction, for the skin.
    void set(double latency, double strength, double misfelt) noexcept;

    GripPhase phase() const { return phase_; }
    bool holds() const { return phase_ != GripPhase::open; }
    /// Both fingers were just felt to touch; `grip`: force of the hand now [N].
    void close(double now, double grip) noexcept;
    /// Begins the load phase, and adds its force to `aim`.
    void lift(double now, Strokes& aim) noexcept;
    /// Starts to release the object.
    void release(double now, Strokes& aim) noexcept;
    /// Call when a held object starts moving along `u`; ends with carried().
    void carry(const Vec3& u) noexcept;
    /// The movement along `u` has ended: the mass felt during it is learned.
    void carried() noexcept;

    /// One tick. `axis`: unit vector from finger to finger.
    void tick(double now, const Feeling& felt, const Vec3& axis, Strokes& aim) noexcept;

    /// Desired inward force of each finger [N].
    double squeeze() const { return squeeze_; }
    /// Force on the object that the plan expects to need, beyond the aim's load [N].
    const Vec3& inertial() const { return inertial_; }
    /// What the appearance of a body suggests.
    const GripMemory& look(int body) const { return looks_[static_cast<size_t>(body)]; }
    /// Recalls what is known of a body, in place of what its appearance suggests.
    void recall(int body, const GripMemory& known) noexcept {
        memory_[static_cast<size_t>(body)] = known;
    }
    const GripMemory& memory(int body) const { return memory_[static_cast<size_t>(body)]; }
    /// The sensation in this tick: touch one reflex latency ago.
    const Feeling& felt() const { return past_.before(latency_); }

  private:
    GripMemory& memory() noexcept { return memory_[static_cast<size_t>(body_)]; }
    bool carries() const noexcept {
        return phase_ == GripPhase::load || phase_ == GripPhase::lifted;
    }
    double needed(const Vec3& force_W, const Vec3& axis) const noexcept;
    double wanted(double now, double load, const Vec3& axis) const noexcept;
    bool lost(double now) const noexcept;
    void feel_skin(double now, const Feeling& newest) noexcept;
    void answer_slip(double now) noexcept;
    void watch_lift(double now, Strokes& aim) noexcept;
    void weigh(double now, Strokes& aim) noexcept;
    void feel_mass(const Feeling& newest) noexcept;
    void remember() noexcept;
    void end() noexcept;

    Traits traits_;
    std::vector<GripMemory> looks_;
    std::vector<GripMemory> memory_;
    double tick_;
    Past<Feeling> past_;
    double latency_ = 0.075;
    double strength_ = 1;
    double misfelt_ = 1;

    GripPhase phase_ = GripPhase::open;
    int body_ = 0;
    double touched_ = 0;    // when both fingers were felt to touch [s]
    double since_ = 0;      // when the phase began [s]
    double probe_ = 0;      // when force is added if the load phase has not lifted the object [s]
    double reflex_ = 0;     // until then a slip counts as the one already answered [s]
    double hold_ = 0;       // squeeze before the load force acts [N]
    double squeeze_ = 0;    // [N]
    double weight_ = 0;     // weight felt in this hold [N]
    bool weighed_ = false;  // held long enough for the weight to be remembered
    Vec3 inertial_ = Vec3::Zero();
    Vec3 along_ = Vec3::Zero();  // direction in which the object is carried; zero: not carried
    double push_ = 0;            // sum of force times acceleration along that direction
    double moved_ = 0;           // sum of squared acceleration along that direction
};

}  // namespace dihaptic::person
