// EnergyGuard watches whether a finger's coupling gives the hand energy that neither hand nor world
// put in, and can damp it. It is a passivity observer and controller in the time domain (Hannaford
// and Ryu 2002) that allows the spring to return its stored energy. README.md derives it.
#pragma once

#include <algorithm>
#include <array>

#include "base/status.h"
#include "haptics/coupling.h"

namespace dihaptic::haptics {

/// Energy that a coupling may generate before it counts as active [J]: the energy of a handle of 75
/// g at 0.5 m/s. Touching, releasing and encoder steps generate up to half of it.
constexpr double kEnergyBudget = 0.01;
/// Time constant of the decay of generated energy [s].
constexpr double kEnergyWindow = 1;
/// Largest damping of the controller, which a Premium renders calmly [N*s/m].
constexpr double kMostEnergyDamping = 5;
/// Largest damping of the controller against turning [N*m*s/rad].
constexpr double kMostEnergyTurnDamping = 0.004;

/// A coupling that generates kEnergyBudget in each of this many windows in a row is active,
/// in any mode of the guard: 1 W for 50 ms is more than a hand absorbs without being shaken.
constexpr double kActiveWindow = 0.01;  // [s]
constexpr int kActiveWindows = 5;

class EnergyGuard {
  public:
    /// `budget` [J].
    explicit EnergyGuard(frame::EnergyGuardMode mode, double budget = kEnergyBudget)
        : mode_(mode), budget_(budget) {}

    /// Called once per tick of h [s] with the handle, the proxy after the tick's step, the wrench
    /// that the coupling requests on the handle from now on, and the energy of its springs at
    /// that time, acting or not [J]. `stepped`: whether the world stepped in this tick; the time
    /// between two steps is judged as a whole. Returns the wrench to add, and adds to
    /// `status`.
    Wrench watch(const frame::Handle& handle, const Pose& X_WP, const Wrench& asked_W,
                 double stored, bool stepped, double h, uint32_t& status) noexcept;

    /// Energy that the coupling generated in the last windows if this exceeded the budget in at
    /// least kActiveWindows in a row, else 0 [J].
    double feeding() const { return windows_ >= kActiveWindows ? fed_ : 0; }
    /// Forgets all earlier states, because the hand may have moved in the meantime.
    void restart() noexcept { *this = EnergyGuard(mode_, budget_); }

    /// Energy generated within the window and not dissipated since [J].
    double generated() const { return *std::min_element(generated_.begin(), generated_.end()); }

  private:
    void count_windows(bool stepped, double h) noexcept;

    frame::EnergyGuardMode mode_;
    double budget_;
    bool started_ = false;
    Pose X_WH_;          // at the last tick
    Pose X_WP_;          // at the last tick
    Wrench asked_;       // requested by the coupling since then
    Wrench damper_;      // added to asked_
    double stored_ = 0;  // in the spring
    // energy generated [J], with the proxy's work done by the force at the end of the tick, and by
    // the force held
    std::array<double, 2> since_step_{};
    std::array<double, 2> generated_{};
    // for feeding(): the window being filled
    std::array<double, 2> in_window_{};  // [J]
    double window_ = 0;                  // [s]
    int windows_ = 0;                    // number of windows in a row above the budget
    double fed_ = 0;                     // energy in these windows [J]
};

}  // namespace dihaptic::haptics
