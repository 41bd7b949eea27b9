// The command `dihaptic bench grasp`: measures how calmly two fingers hold a block, and related
// figures of coupling and devices. docs/measures.md defines the figures.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/plant.h"

namespace dihaptic::measure {

struct HoldFigures {
    double k = 0;
    Fingering fingering = Fingering::ideal;
    bool held = false;
    double lift_slip_mm = 0;
    double slip_mm = 0;
    double z_rms_um = 0;
    double z_pp_um = 0;
    double tilt_rms_deg = 0;
    double turn_deg = 0;
    double hf_force_n = 0;
    double weight_ratio = 0;
    double grip_ratio = 0;
};

struct SlowFigures {
    double k = 0;
    bool held = false;
    double slip_mm = 0;
    double hf_force_n = 0;
};

struct KickFigures {
    double k = 0;
    double speed = 0;  ///< [m/s]
    double kick_ratio = 0;
    double touch_step_n = 0;
    double leave_pull_n = 0;
};

struct GraspFigures {
    double damping_per_k = 0;  ///< default damping over K [s]
    std::vector<HoldFigures> hold;
    std::vector<SlowFigures> slow_dynamics;
    double calm_k = 0, calm_k_delay = 0, calm_k_premium = 0;
    double wall_k = 0, wall_k_delay = 0, wall_k_premium = 0;
    double torque_turn_deg = 0;
    double torque_turn_after_deg = 0;
    /// For soft fingertips; unset if proxy or solver have no torsion.
    std::optional<double> torsion_limit_ratio;
    std::vector<KickFigures> kick;
    double drag_n = 0;
};

/// Measures one lift and hold, with setup.settings.coupling.stiffness.
HoldFigures measure_hold(const BenchSetup& setup);
/// `grip_slack`: share of the grip that the device's friction may take.
bool calm_grasp(const HoldFigures& hold, double grip_slack = 0);
/// Whether one finger that is pressed 15 mm into a fixed wall is calm.
bool calm_wall(const BenchSetup& setup);
/// Measures touching a wall at a speed, and leaving it.
KickFigures measure_kick(BenchSetup setup, double speed);
/// Peak handle force on a free minimum-jerk path of 20 cm with a peak of 0.5 m/s [N].
double measure_drag(const BenchSetup& setup);
/// Turn by a torque of 0.02 N*m for 0.2 s in the hold: at the torque's end, and 1 s later [deg].
std::pair<double, double> measure_torque(const BenchSetup& setup);

/// Moment about the grasp axis that soft contacts of radius r bear, when fingers hold the block at
/// the closed form's grip: sum of mu r N sqrt(1 - (T / (mu N))^2), with T half the weight [N*m].
double torsion_limit(const BenchSetup& setup);
/// Torque about the grasp axis, rising slowly in the hold, at which the block lets go, over
/// torsion_limit().
double measure_torsion_limit(const BenchSetup& setup);
/// Largest turn about the grasp axis in the hold under a torque of `share` times torsion_limit()
/// [deg].
double measure_soft_turn(const BenchSetup& setup, double share);

/// Highest K of the list up to which every K is calm; 0 if there is none.
double highest_calm(const std::function<bool(double k)>& calm);

using Progress = std::function<void(const std::string& what, double share)>;
/// Measures all figures. `setup` gives solver, coupling, mass, friction and rate.
GraspFigures bench_grasp(const BenchSetup& setup, const Progress& progress);

std::string to_json(const GraspFigures& figures, const BenchSetup& setup);
struct GraspResult {
    BenchSetup setup;
    GraspFigures figures;
};
/// One table, with the measured couplings beside each other.
std::string to_table(const std::vector<GraspResult>& results);

}  // namespace dihaptic::measure
