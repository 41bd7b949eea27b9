// Implements the command `dihaptic bench grasp`, which measures how calmly two fingers hold a
// block, and related figures of the coupling and the devices. docs/measures.md defines the figures.
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

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("k", f.k, "", "stiffness of the coupling [N/m]");
        v("fingering", f.fingering, "", "how the fingers hold the block");
        v("held", f.held, "", "from lift-off to opening");
        v("lift_slip_mm", f.lift_slip_mm, "mm", "slip of a finger in the lift");
        v("slip_mm", f.slip_mm, "mm", "slip of a finger in the hold");
        v("z_rms_um", f.z_rms_um, "um", "RMS of the block's height");
        v("z_pp_um", f.z_pp_um, "um", "peak to peak of the block's height");
        v("tilt_rms_deg", f.tilt_rms_deg, "deg", "turn of the grasp axis about its mean");
        v("turn_deg", f.turn_deg, "deg", "turn of the block about the grasp axis");
        v("hf_force_n", f.hf_force_n, "N", "handle force above 5 Hz, RMS");
        v("weight_ratio", f.weight_ratio, "1", "ratio of vertical handle forces to the weight");
        v("grip_ratio", f.grip_ratio, "1", "ratio of pinch force to its closed form");
    }
};

struct SlowFigures {
    double k = 0;
    bool held = false;
    double slip_mm = 0;
    double hf_force_n = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("k", f.k, "", "stiffness of the coupling [N/m]");
        v("held", f.held, "", "from lift-off to opening");
        v("slip_mm", f.slip_mm, "mm", "slip of a finger in the hold");
        v("hf_force_n", f.hf_force_n, "N", "handle force above 5 Hz, RMS");
    }
};

struct KickFigures {
    double k = 0;
    double speed = 0;  ///< [m/s]
    double kick_ratio = 0;
    double touch_step_n = 0;
    double leave_pull_n = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("k", f.k, "", "stiffness of the coupling [N/m]");
        v("speed", f.speed, "m/s", "speed of the hand");
        v("kick_ratio", f.kick_ratio, "1",
          "ratio of peak force to that of a spring in continuous time");
        v("touch_step_n", f.touch_step_n, "N", "force in the first tick in excess of the spring's");
        v("leave_pull_n", f.leave_pull_n, "N", "largest pull toward the wall when leaving it");
    }
};

struct GraspFigures {
    // setup
    frame::CouplingKind coupling{};
    contact::Solver solver{};
    scene::ProxyKind proxy{};
    frame::PointFriction point_friction{};
    std::string damping;  ///< default damping of the coupling, as a multiple of K
    double mass = 0;      ///< [kg]
    double friction = 0;
    double rate = 0;  ///< [Hz]

    std::vector<HoldFigures> hold;
    std::vector<SlowFigures> slow_dynamics;
    double calm_k = 0, calm_k_delay = 0, calm_k_premium = 0;
    double wall_k = 0, wall_k_delay = 0, wall_k_premium = 0;
    double torque_turn_deg = 0;
    double torque_turn_after_deg = 0;
    /// Only for soft fingertips; unset if the proxy has no torsional friction.
    std::optional<double> torsion_limit_ratio;
    std::vector<KickFigures> kick;
    double drag_n = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("coupling", f.coupling, "", "coupling of handle and proxy");
        v("solver", f.solver, "", "solver of contacts");
        v("proxy", f.proxy, "", "model of a finger");
        v("point_friction", f.point_friction, "", "how a point's friction is computed");
        v("damping", f.damping, "", "damping of the coupling, as a multiple of its stiffness");
        v("mass", f.mass, "g", "mass of the block");
        v("friction", f.friction, "1", "coefficient of friction");
        v("rate_hz", f.rate, "Hz", "ticks per second");
        v("hold", f.hold, "", "lifting and holding a block");
        v("slow_dynamics", f.slow_dynamics, "",
          "lifting and holding with the world stepped every 10 ticks");
        v("calm_k", f.calm_k, "", "highest K that holds the block calmly [N/m]");
        v("calm_k_delay", f.calm_k_delay, "", "the same, with a tick of delay [N/m]");
        v("calm_k_premium", f.calm_k_premium, "", "the same, on a Premium [N/m]");
        v("wall_k", f.wall_k, "", "highest K that is calm on a wall [N/m]");
        v("wall_k_delay", f.wall_k_delay, "", "the same, with a tick of delay [N/m]");
        v("wall_k_premium", f.wall_k_premium, "", "the same, on a Premium [N/m]");
        v("torque_turn_deg", f.torque_turn_deg, "deg", "turn by 0.02 N*m for 0.2 s");
        v("torque_turn_after_deg", f.torque_turn_after_deg, "deg", "turn 1 s later");
        v("torsion_limit_ratio", f.torsion_limit_ratio, "1",
          "ratio of the torque that turns the block to its closed form");
        v("kick", f.kick, "", "touching and leaving a wall");
        v("drag_n", f.drag_n, "N", "peak force in free motion");
    }
};

/// Measures one lift and hold, using setup.settings.coupling.stiffness.
HoldFigures measure_hold(const BenchSetup& setup);
/// Measures one lift and hold in a different scene, in which the object must weigh as much as in
/// the setup.
HoldFigures measure_hold(const BenchSetup& setup, const scene::Scene& scene);
/// Whether the hold is calm. `grip_slack`: fraction of the grip force that the device's friction
/// may absorb.
bool calm_grasp(const HoldFigures& hold, double grip_slack = 0);
/// Whether the force stays calm when one finger is pressed 15 mm into a fixed wall.
bool calm_wall(const BenchSetup& setup);
/// Measures the forces when a finger touches a wall at the given speed and leaves it again.
KickFigures measure_kick(BenchSetup setup, double speed);
/// Returns the peak force on a handle in free minimum-jerk movement over 20 cm, with a peak speed
/// of 0.5 m/s [N].
double measure_drag(const BenchSetup& setup);
/// Returns the rotation caused by a torque of 0.02 N*m that acts for 0.2 s during the hold: at the
/// end of the torque, and 1 s later [deg].
std::pair<double, double> measure_torque(const BenchSetup& setup);

/// Returns the moment about the grasp axis that soft contacts of radius r can bear when the fingers
/// hold the block with the closed-form grip force: sum of mu r N sqrt(1 - (T / (mu N))^2), where T
/// is half the weight [N*m].
double torsion_limit(const BenchSetup& setup);
/// Returns the torque about the grasp axis at which the block starts to turn, as a multiple of
/// torsion_limit(). The torque rises slowly during the hold.
double measure_torsion_limit(const BenchSetup& setup);
/// Returns the largest rotation about the grasp axis during the hold, under a torque of `share`
/// times torsion_limit() [deg].
double measure_soft_turn(const BenchSetup& setup, double share);

/// Returns the highest K in the list that is calm and below which every other K is calm too; 0 if
/// there is none.
double highest_calm(const std::function<bool(double k)>& calm);

using Progress = std::function<void(const std::string& what, double share)>;
/// Measures all figures. `setup` determines solver, coupling, mass, friction and rate.
GraspFigures bench_grasp(const BenchSetup& setup, const Progress& progress);

std::string to_json(const GraspFigures& figures);

}  // namespace dihaptic::measure
