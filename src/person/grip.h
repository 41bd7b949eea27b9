// A simulated person's grip and lift, in the phases described by Johansson and Westling (1984): the
// grip force follows a plan based on the expected weight and friction, and touch corrects the grip
// force one reflex latency later. README.md has the equations.
#pragma once

#include <vector>

#include "person/body_memories.h"
#include "person/past.h"
#include "person/strokes.h"
#include "person/touch.h"

namespace dihaptic::person {

enum class GripPhase {
    open,     ///< the fingers follow the aim
    preload,  ///< the fingers touch and press; there is no load force yet
    ready,    ///< the object is gripped, but not being lifted
    load,     ///< grip and load force rise together until the object lifts off
    lifted,   ///< grip force has an initial peak, then is constant
    unload,   ///< grip and load force fall together
};

class Grip {
  public:
    Grip(const Traits& traits, BodyMemories memories, double tick);

    /// `before`: what is known from earlier sessions.
    void restart(const std::vector<Learned::OfBody>& before) noexcept;
    /// The values that differ from trial to trial.
    struct Trial {
        double latency = 0.075;  ///< reflex latency [s]
        double strength = 1;     ///< ratio of the grip force to the planned one
        double misfelt = 1;      ///< ratio of the friction felt by the skin to the true one
        double slowness = 1;     ///< ratio of the duration of the load phase to the usual one
    };
    void set(const Trial& trial) noexcept;

    GripPhase phase() const { return phase_; }
    bool holds() const { return phase_ != GripPhase::open; }
    /// To be called when both fingers are felt to touch. `grip`: current force of the hand [N].
    void close(double now, double grip) noexcept;
    /// Begins the load phase, and adds the load force to `aim`.
    void lift(double now, Strokes& aim) noexcept;
    /// Starts to release the object.
    void release(double now, Strokes& aim) noexcept;
    /// To be called when a held object starts to move along `u`; the movement ends with carried().
    void carry(const Vec3& u) noexcept;
    /// To be called when the movement along `u` has ended: learns the mass felt during it.
    void carried() noexcept;

    /// Advances by one tick. `axis`: unit vector from finger to finger.
    void tick(double now, const Feeling& felt, const Vec3& axis, Strokes& aim) noexcept;

    /// Desired inward force of each finger [N].
    double squeeze() const { return squeeze_; }
    /// Planned force on the object, in addition to the load force of the aim [N].
    const Vec3& inertial() const { return inertial_; }
    const BodyMemories& memories() const { return memories_; }
    /// What is felt in this tick, i.e. the touch one reflex latency ago.
    const Feeling& felt() const { return past_.before(trial_.latency); }

  private:
    GripMemory& memory() noexcept { return memories_.of(body_); }
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
    BodyMemories memories_;
    double tick_;
    Past<Feeling> past_;
    Trial trial_;

    GripPhase phase_ = GripPhase::open;
    int body_ = 0;
    double touched_ = 0;    // time when both fingers were felt to touch [s]
    double since_ = 0;      // time when the phase began [s]
    double probe_ = 0;      // time of the next force increase if the object has not lifted off [s]
    double reflex_ = 0;     // time until which a slip counts as already answered [s]
    double hold_ = 0;       // squeeze before there is a load force [N]
    double squeeze_ = 0;    // [N]
    double weight_ = 0;     // weight felt in this hold [N]
    bool weighed_ = false;  // whether the hold was long enough to remember the weight
    Vec3 inertial_ = Vec3::Zero();
    Vec3 along_ = Vec3::Zero();  // direction in which the object is carried; zero if it is not
    double push_ = 0;            // sum of force times acceleration along along_
    double moved_ = 0;           // sum of squared acceleration along along_
};

}  // namespace dihaptic::person
