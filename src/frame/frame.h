// The Frame is the record of a tick. Each quantity is described once, in visit(), from which the
// log, the NWB file, docs/quantities.md, summaries and plots are all derived.
#pragma once

#include <cstdint>
#include <vector>

#include "base/clock.h"
#include "base/geometry.h"
#include "base/status.h"
#include "base/unmeasured.h"
#include "frame/knobs.h"
#include "frame/task_frame.h"
#include "frame/term.h"

namespace dihaptic::frame {

using enum Status;  // the status bits of a Frame, e.g. kStopped

struct FingerFrame {
    Vec3 p_DH = Vec3::Zero();
    Vec3 v_DH = Vec3::Zero();
    uint32_t buttons = 0;
    uint32_t status = 0;
    Vec3 p_WH = Vec3::Zero();
    Vec3 v_WH = Vec3::Zero();
    Vec3 p_WP = Vec3::Zero();
    Vec3 v_WP = Vec3::Zero();
    Quat R_WP = Quat::Identity();
    Vec3 f_asked_W = Vec3::Zero();
    Vec3 f_sent_W = Vec3::Zero();
    Vec3 f_contact_W = Vec3::Zero();
    double normal_force = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v(f.p_DH, {"device_position", "m", "D", "Position of the handle, from the device."});
        v(f.v_DH, {"device_velocity", "m/s", "D", "Velocity of the handle, from the device."});
        v(f.buttons,
          {"buttons", "1", "",
           "Sum over the pressed buttons: 1 for the first, 2 for the second, 4 for the third."});
        v(f.status, {"status", "1", "", "Sum of the status bits of this finger."});
        v(f.p_WH, {"handle_position", "m", "W", "Position of the handle."});
        v(f.v_WH, {"handle_velocity", "m/s", "W",
                   "Velocity of the handle, including the rotation of the workspaces."});
        v(f.p_WP, {"proxy_position", "m", "W",
                   "Position of the proxy, which represents the finger in the world."});
        v(f.v_WP, {"proxy_velocity", "m/s", "W", "Velocity of the proxy."});
        v(f.R_WP, {"proxy_orientation", "1", "W",
                   "Unit quaternion that turns the proxy's axes into the world's."});
        v(f.f_asked_W,
          {"force_asked", "N", "W", "Force on the handle, as requested by the coupling."});
        v(f.f_sent_W, {"force_sent", "N", "W", "Force on the handle, as sent to the device."});
        v(f.f_contact_W,
          {"contact_force", "N", "W", "Force on the proxy from the bodies that it touches."});
        v(f.normal_force,
          {"normal_force", "N", "", "Normal component of contact_force, at least 0."});
    }
};

struct TurnFrame {
    Quat R_DH = Quat::Identity();
    Vec3 w_DH = Vec3::Zero();
    Quat R_WH = Quat::Identity();
    Vec3 w_WH = Vec3::Zero();
    Vec3 w_WP = Vec3::Zero();
    Vec3 t_asked_W = Vec3::Zero();
    Vec3 t_sent_W = Vec3::Zero();

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v(f.R_DH, {"device_orientation", "1", "D",
                   "Rotation of the handle from its device's neutral orientation."});
        v(f.w_DH, {"device_angular_velocity", "rad/s", "D",
                   "Angular velocity of the handle, from the device."});
        v(f.R_WH,
          {"handle_orientation", "1", "W", "Rotation of the handle from its neutral orientation."});
        v(f.w_WH, {"handle_angular_velocity", "rad/s", "W",
                   "Angular velocity of the handle, including the rotation of the workspaces."});
        v(f.w_WP, {"proxy_angular_velocity", "rad/s", "W", "Angular velocity of the proxy."});
        v(f.t_asked_W,
          {"torque_asked", "N*m", "W", "Torque on the handle, as requested by the coupling."});
        v(f.t_sent_W, {"torque_sent", "N*m", "W", "Torque on the handle, as sent to the device."});
    }
};

struct BodyFrame {
    Pose X_WB;
    Vec3 v_WB = Vec3::Zero();
    Vec3 w_WB = Vec3::Zero();
    uint32_t awake = 1;

    template <class Self, class Visitor>
    static void visit(Self& b, Visitor& v) {
        v(b.X_WB.p, {"position", "m", "W", "Position of the body's origin."});
        v(b.X_WB.R, {"orientation", "1", "W",
                     "Unit quaternion that turns the body's axes into the world's."});
        v(b.v_WB, {"velocity", "m/s", "W", "Velocity of the body's origin."});
        v(b.w_WB, {"angular_velocity", "rad/s", "W", "Angular velocity of the body."});
        v(b.awake, {"awake", "1", "", "0 if the body sleeps or is fixed, otherwise 1."});
    }
};

struct JointFrame {
    double angle = kUnmeasured;
    double angular_velocity = kUnmeasured;
    double displacement = kUnmeasured;
    double velocity = kUnmeasured;
    Vec3 f_B_W = Vec3::Zero();
    Vec3 t_B_W = Vec3::Zero();

    template <class Self, class Visitor>
    static void visit(Self& j, Visitor& v) {
        v(j.angle, {"angle", "rad", "",
                    "Angle of a hinge's second body relative to the first, 0 at the start; NaN for "
                    "other joints."});
        v(j.angular_velocity, {"angular_velocity", "rad/s", "", "Rate of change of the angle."});
        v(j.displacement, {"displacement", "m", "",
                           "Displacement of a slider's second body relative to the first, 0 at the "
                           "start, or the distance in a distance joint; NaN for other joints."});
        v(j.velocity, {"velocity", "m/s", "", "Rate of change of the displacement."});
        v(j.f_B_W, {"force", "N", "W",
                    "Force on the second body at the joint, including spring, friction and "
                    "stops."});
        v(j.t_B_W,
          {"torque", "N*m", "W",
           "Torque on the second body at the joint, including spring, friction and stops."});
    }
};

struct ContactFrame {
    int32_t a = -1;
    int32_t b = -1;
    int32_t points = 0;
    Vec3 p_WC = Vec3::Zero();
    Vec3 n_W = Vec3::Zero();
    double gap = 0;
    double normal_force = 0;
    Vec3 f_B_W = Vec3::Zero();

    template <class Self, class Visitor>
    static void visit(Self& c, Visitor& v) {
        v(c.a, {"body_a", "1", "",
                "Index of the first body; fingers' proxies come after the scene's bodies."});
        v(c.b, {"body_b", "1", "", "Index of the second body."});
        v(c.points, {"points", "1", "", "Number of contact points."});
        v(c.p_WC,
          {"position", "m", "W", "Centre of pressure; without pressure, the mean of the points."});
        v(c.n_W, {"normal", "1", "W", "Mean normal, from the first body to the second."});
        v(c.gap, {"gap", "m", "", "Smallest distance; negative: penetration."});
        v(c.normal_force, {"normal_force", "N", "", "Sum of the normal forces."});
        v(c.f_B_W, {"force_on_b", "N", "W", "Total force on the second body."});
    }
};

/// A Frame contains the Knobs that are in effect in its tick.
struct Frame : Knobs {
    int64_t sequence = 0;
    Time time{0};
    int32_t trial = 0;
    int32_t phase = 0;
    uint32_t status = 0;
    double grip_force = kUnmeasured;
    double load_force = 0;
    // summary over the islands of the step; an island is a set of bodies that touch, directly or
    // through other bodies, and that are solved separately from the rest
    int32_t solver_iterations = 0;
    int32_t solver_fallback = 0;
    int32_t solver_route = 0;  ///< contact::Route
    double solver_residual = 0;
    double solver_held_residual = kUnmeasured;
    // energy and momentum balances of the step (dynamics/balance.h)
    double kinetic_energy = kUnmeasured;
    double potential_energy = kUnmeasured;
    double work = kUnmeasured;
    double dissipation = kUnmeasured;
    double energy_imbalance = kUnmeasured;
    double momentum_imbalance = kUnmeasured;
    double angular_imbalance = kUnmeasured;
    double lateness = kUnmeasured;
    double tick_duration = kUnmeasured;
    TaskFrame task;
    std::vector<FingerFrame> fingers;
    std::vector<TurnFrame> turns;
    std::vector<BodyFrame> bodies;
    /// Indices of the bodies that changed since the last frame; only these bodies are logged.
    std::vector<uint16_t> changed;
    std::vector<JointFrame> joints;
    std::vector<ContactFrame> contacts;

    /// Calls v(value, Term) for each value and, for each list, v.each(name, list, meaning) or
    /// v.changed(name, list, which, meaning).
    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v(f.sequence, {"sequence", "1", "", "Number of the tick, from 0."});
        v(f.time, {"time", "ns", "", "Time of the tick, since activation."});
        v(f.trial, {"trial", "1", "", "Number of the trial, from 1; 0: none."});
        v(f.phase, {"phase", "1", "", "Index of the trial's phase in the session's list."});
        v(f.status, {"status", "1", "", "Sum of the status bits of the tick and of its fingers."});
        v(f.grip_force,
          {"grip_force", "N", "",
           "Pinch component of the normal forces, half their sum; NaN for one finger."});
        v(f.load_force, {"load_force", "N", "",
                         "Tangential contact forces along gravity, summed over the fingers."});
        Knobs::visit([&](auto knob, const Knob& is) {
            v(f.*knob, {is.name, is.unit, "", is.what});
        });
        v(f.solver_iterations, {"solver_iterations", "1", "",
                                "Iterations of all solvers in the step, summed over its islands."});
        v(f.solver_fallback,
          {"solver_fallback", "1", "",
           "1 if any island was solved by a solver other than the requested one, otherwise 0."});
        v(f.solver_route, {"solver_route", "1", "", "Method that found the impulses used."});
        v(f.solver_residual,
          {"solver_residual", "1", "",
           "Largest error in Coulomb's law, as defined in src/contact/README.md."});
        v(f.solver_held_residual, {"solver_held_residual", "1", "",
                                   "The same error, at contacts of bodies that a finger touches, "
                                   "directly or through others."});
        v(f.kinetic_energy, {"kinetic_energy", "J", "",
                             "Kinetic energy of all freely moving bodies, half a step before the "
                             "time of their positions."});
        v(f.potential_energy, {"potential_energy", "J", "",
                               "Potential energy of these bodies' weights, zero at the world's "
                               "origin, and of springs, at the time of kinetic_energy."});
        v(f.work, {"work", "J", "",
                   "Work done on freely moving bodies in the step by fingers, loads, motors and "
                   "driven bodies, and the energy of changes that the experiment makes."});
        v(f.dissipation, {"dissipation", "J", "",
                          "Energy dissipated by friction, dampers and impacts in the step."});
        v(f.energy_imbalance, {"energy_imbalance", "J", "",
                               "Unexplained energy in the step: the change of kinetic_energy and "
                               "potential_energy, minus work, plus dissipation."});
        v(f.momentum_imbalance,
          {"momentum_imbalance", "N*s", "",
           "Largest change of a body's momentum in the step that no force explains."});
        v(f.angular_imbalance,
          {"angular_imbalance", "N*m*s", "",
           "Largest change of a body's angular momentum in the step that no force explains."});
        v(f.lateness, {"lateness", "s", "", "Lateness of the wake-up; NaN on the virtual clock."});
        v(f.tick_duration,
          {"tick_duration", "s", "", "Duration of the last tick; NaN on the virtual clock."});
        TaskFrame::visit(f.task, v);
        v.each("fingers", f.fingers, "One for each finger of the scene, in order.");
        v.each("turns", f.turns, "One for each finger whose device measures orientation.");
        v.changed("bodies", f.bodies, f.changed, "One for each body of the scene, in order.");
        v.each("joints", f.joints, "One for each joint of the scene, in order.");
        v.each("contacts", f.contacts, "One for all contact points between two bodies.");
    }
};

}  // namespace dihaptic::frame
