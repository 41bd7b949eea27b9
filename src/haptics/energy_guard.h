// Watches that a finger's coupling gives the hand no energy that nobody put in: a passivity
// observer and controller in the time domain (Hannaford and Ryu 2002), with the energy of the
// spring as what may be returned. README.md derives it.
#pragma once

#include <algorithm>
#include <array>

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
/// The same against turning [N*m*s/rad].
constexpr double kMostEnergyTurnDamping = 0.004;

/// A coupling that generates kEnergyBudget in each of so many windows in a row is active, whatever
/// the guard's mode: that is a watt for 50 ms, more than a hand takes without being shaken.
constexpr double kActiveWindow = 0.01;  // [s]
constexpr int kActiveWindows = 5;

class EnergyGuard {
  public:
    /// `budget` [J].
    explicit EnergyGuard(EnergyGuardMode mode, double budget = kEnergyBudget)
        : mode_(mode), budget_(budget) {}

    /// Once a tick of h [s]: the handle, the proxy after the tick's step, what the coupling wants
    /// to do to the handle from now on, and the energy that its springs have then, though they may
    /// not act [J]. `stepped`: the world did, in this tick: what comes between two steps is judged
    /// as a whole. Returns what to add.
    Wrench watch(const Handle& handle, const Pose& X_WP, const Wrench& asked_W, double stored,
                 bool stepped, double h, unsigned& flags) noexcept;

    /// What the coupling generated in the last windows, when it did so in all of them, or else 0
    /// [J].
    double feeding() const { return windows_ >= kActiveWindows ? fed_ : 0; }
    /// Forgets all that it saw: what comes next may be elsewhere.
    void restart() noexcept { *this = EnergyGuard(mode_, budget_); }

    /// Generated within the window, and not dissipated since [J].
    double generated() const { return *std::min_element(generated_.begin(), generated_.end()); }

  private:
    void count_windows(bool stepped, double h) noexcept;

    EnergyGuardMode mode_;
    double budget_;
    bool started_ = false;
    Pose X_WH_;          // at the last tick
    Pose X_WP_;          // the same
    Wrench asked_;       // what the coupling has wanted since then
    Wrench damper_;      // what was added to it
    double stored_ = 0;  // in the spring
    // generated [J]: the proxy's work by the force at the end of the tick, and by the one held
    std::array<double, 2> since_step_{};
    std::array<double, 2> generated_{};
    // for feeding(): the window that is being filled
    std::array<double, 2> in_window_{};  // [J]
    double window_ = 0;                  // [s]
    int windows_ = 0;                    // so far in a row that were above the budget
    double fed_ = 0;                     // in these [J]
};

}  // namespace dihaptic::haptics
