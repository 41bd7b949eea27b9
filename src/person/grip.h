// Gripping and lifting in the phases of Johansson and Westling (1984), by a plan that expects a
// weight and a friction, and by touch, which corrects it a reflex latency later. README.md has the
// equations.
#pragma once

#include <vector>

#include "person/grip_memory.h"
#include "person/past.h"
#include "person/strokes.h"
#include "person/touch.h"

namespace dihaptic::person {

enum class GripPhase {
    open,     ///< fingers go where they are led
    preload,  ///< both touch: they press, and the load has not begun
    ready,    ///< gripped, not lifted
    load,     ///< grip and load rise together, until the object is felt to come off
    lifted,   ///< with a peak at first, then static
    unload,   ///< grip and load fall together
};

class Grip {
  public:
    /// `memory`: of each body of the scene, as it looks.
    Grip(const Traits& traits, std::vector<GripMemory> memory, double tick);

    void restart() noexcept;
    /// Of this trial: the reflexes' latency [s]; how strongly the hand grips, 1 as it should; by
    /// what factor its skin errs about friction.
    void set(double latency, double strength, double misfelt) noexcept;

    GripPhase phase() const { return phase_; }
    bool holds() const { return phase_ != GripPhase::open; }
    /// Just felt both fingers touch; `grip`: how hard the hand presses now [N].
    void close(double now, double grip) noexcept;
    /// Begins the load phase; `aim` takes its force.
    void lift(double now, Strokes& aim) noexcept;
    /// Begins to let go.
    void release(double now, Strokes& aim) noexcept;
    /// A carried object is led along u from now on, until carried().
    void carry(const Vec3& u) noexcept;
    /// ... and this has ended: what was felt is learned.
    void carried() noexcept;

    /// One tick. `axis`: unit, from finger to finger.
    void tick(double now, const Feeling& felt, const Vec3& axis, Strokes& aim) noexcept;

    /// How hard each finger is to press inward [N].
    double squeeze() const { return squeeze_; }
    /// Force on the object that the plan expects to need, beyond the aim's load [N].
    const Vec3& inertial() const { return inertial_; }
    const GripMemory& memory(int body) const { return memory_[static_cast<size_t>(body)]; }
    /// Of this tick's senses, a reflex latency ago.
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
    double touched_ = 0;    // when both fingers felt it [s]
    double since_ = 0;      // when the phase began [s]
    double probe_ = 0;      // when more force is added to a load phase that has lifted nothing [s]
    double reflex_ = 0;     // until when a slip is the one that was answered [s]
    double hold_ = 0;       // squeeze before the load [N]
    double squeeze_ = 0;    // [N]
    double weight_ = 0;     // felt in this hold [N]
    bool weighed_ = false;  // long enough to be remembered
    Vec3 inertial_ = Vec3::Zero();
    Vec3 along_ = Vec3::Zero();  // that it is carried; zero: it is not
    double push_ = 0;            // sums of force times acceleration along it, and ...
    double moved_ = 0;           // ... of acceleration squared
};

}  // namespace dihaptic::person
