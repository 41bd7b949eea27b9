// Watches that a finger's coupling gives the hand no energy that nobody put in: a passivity
// observer and controller in the time domain (Hannaford and Ryu 2002), with the energy of the
// spring as what may be returned. README.md derives it.
#pragma once

#include "haptics/coupling.h"

namespace dihaptic::haptics {

/// What the guard had to say in a tick: see also LimitFlags.
enum EnergyFlags : unsigned {
    kEnergyGenerated = 1u << 8,  ///< more than kEnergyBudget came out that nobody put in
    kEnergyDamped = 1u << 9,     ///< and a damper took of it
};

/// Energy that a coupling may generate before it counts as active [J]: a handle of 75 g has it at
/// 0.5 m/s. Touching, letting go and encoder steps generate up to half of it.
constexpr double kEnergyBudget = 0.01;
/// In which time [s]: what is older is forgotten.
constexpr double kEnergyWindow = 1;
/// The controller's damping, at most: what a Premium renders calmly [N*s/m].
constexpr double kMostEnergyDamping = 5;

class EnergyGuard {
  public:
    explicit EnergyGuard(EnergyGuardMode mode) : mode_(mode) {}

    /// Once a tick of h [s]: the handle, the proxy after the tick's step, the force on the handle
    /// that the coupling wants from now on, and the energy that its spring has then [J]. `stepped`:
    /// the world did, in this tick: what comes between two steps is judged as a whole. Returns the
    /// force to add [N].
    Vec3 watch(const Handle& handle, const Vec3& p_WP, const Vec3& f_H_W, double stored,
               bool stepped, double h, unsigned& flags) noexcept;

    /// Generated within the window, and not dissipated since [J].
    double generated() const { return generated_; }

  private:
    EnergyGuardMode mode_;
    bool started_ = false;
    Vec3 p_WH_ = Vec3::Zero();    // at the last tick
    Vec3 p_WP_ = Vec3::Zero();    // the same
    Vec3 f_H_W_ = Vec3::Zero();   // what the coupling has wanted since then
    Vec3 damper_ = Vec3::Zero();  // what was added to it
    double stored_ = 0;           // in the spring
    double since_step_ = 0;       // generated [J]
    double generated_ = 0;
};

}  // namespace dihaptic::haptics
