// The Frame is the record of a tick. Log, NWB file, summaries and plots all follow from its
// visit().
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/geometry.h"
#include "base/unmeasured.h"
#include "servo/task_frame.h"

namespace dihaptic::servo {

/// Why a tick could not do as asked; describe() gives the remedies.
enum Status : uint32_t {
    kContactsFull = 1u << 0,
    kForceLimited = 1u << 1,
    kRateLimited = 1u << 2,
    kNotFinite = 1u << 3,
    kOutsideWorkspace = 1u << 4,
    kForceClamped = 1u << 5,
    kNoMoreData = 1u << 6,
    kOverrun = 1u << 7,
    kSolverFallback = 1u << 8,
    kSolverMissed = 1u << 9,
    kForceOff = 1u << 10,
    kBadReading = 1u << 11,
    kNotAnswering = 1u << 12,
    kTooFast = 1u << 13,
    kLate = 1u << 14,
    kHeatLimited = 1u << 15,
    kPushedInward = 1u << 16,
    kSoftStarted = 1u << 17,
    kSwitchedOff = 1u << 18,
    kEnergyGenerated = 1u << 19,
    kEnergyDamped = 1u << 20,
    kStopped = 1u << 21,
    kResumed = 1u << 22,
    kForceDropped = 1u << 23,
    kUncalibrated = 1u << 24,
    kDeviceFault = 1u << 25,
    kKeepsLate = 1u << 26,
    kSoftened = 1u << 27,
    kAbandoned = 1u << 28,
    kPaused = 1u << 29,
};
constexpr int kStatusBits = 30;
constexpr uint32_t kAllStatus = (1u << kStatusBits) - 1;

struct StatusText {
    std::string what;
    std::string remedy;
};
/// The text for one bit.
StatusText describe(Status bit);
/// What each set bit says, "; " between them.
std::string words(uint32_t status);

/// Calls `use` with each set Status, lowest bit first; a later version's log may have bits beyond
/// them, which are passed over.
template <class Use>
void for_each_status(uint32_t status, Use use) {
    for (uint32_t left = status & kAllStatus; left != 0; left &= left - 1)
        use(static_cast<Status>(left & ~(left - 1)));
}

struct FingerFrame {
    Vec3 p_DH = Vec3::Zero();  ///< as read from the device
    Vec3 v_DH = Vec3::Zero();
    uint32_t buttons = 0;
    uint32_t status = 0;  ///< Status bits of this finger
    Vec3 p_WH = Vec3::Zero();
    Vec3 v_WH = Vec3::Zero();
    Vec3 p_WP = Vec3::Zero();
    Vec3 v_WP = Vec3::Zero();
    Quat R_WP = Quat::Identity();
    Vec3 f_asked_W = Vec3::Zero();    ///< on the handle, as the coupling asks
    Vec3 f_sent_W = Vec3::Zero();     ///< on the handle, as sent to the device
    Vec3 f_contact_W = Vec3::Zero();  ///< on the proxy, from what it touches
    double normal_force = 0;          ///< normal part of the contact force, at least 0

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("device_position", f.p_DH, "m");
        v("device_velocity", f.v_DH, "m/s");
        v("buttons", f.buttons, "1");
        v("status", f.status, "1");
        v("handle_position", f.p_WH, "m");
        v("handle_velocity", f.v_WH, "m/s");
        v("proxy_position", f.p_WP, "m");
        v("proxy_velocity", f.v_WP, "m/s");
        v("proxy_orientation", f.R_WP, "1");
        v("force_asked", f.f_asked_W, "N");
        v("force_sent", f.f_sent_W, "N");
        v("contact_force", f.f_contact_W, "N");
        v("normal_force", f.normal_force, "N");
    }
};

/// Additional values of a finger whose device measures orientation.
struct TurnFrame {
    Quat R_DH = Quat::Identity();  ///< as read from the device, relative to its neutral orientation
    Vec3 w_DH = Vec3::Zero();
    Quat R_WH = Quat::Identity();
    Vec3 w_WH = Vec3::Zero();
    Vec3 w_WP = Vec3::Zero();
    Vec3 t_asked_W = Vec3::Zero();  ///< on the handle, as the coupling asks
    Vec3 t_sent_W = Vec3::Zero();   ///< on the handle, as sent to the device

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("device_orientation", f.R_DH, "1");
        v("device_angular_velocity", f.w_DH, "rad/s");
        v("handle_orientation", f.R_WH, "1");
        v("handle_angular_velocity", f.w_WH, "rad/s");
        v("proxy_angular_velocity", f.w_WP, "rad/s");
        v("torque_asked", f.t_asked_W, "N*m");
        v("torque_sent", f.t_sent_W, "N*m");
    }
};

struct BodyFrame {
    Pose X_WB;
    Vec3 v_WB = Vec3::Zero();
    Vec3 w_WB = Vec3::Zero();
    uint32_t awake = 1;

    template <class Self, class Visitor>
    static void visit(Self& b, Visitor& v) {
        v("position", b.X_WB.p, "m");
        v("orientation", b.X_WB.R, "1");
        v("velocity", b.v_WB, "m/s");
        v("angular_velocity", b.w_WB, "rad/s");
        v("awake", b.awake, "1");
    }
};

/// All contact points between two bodies, taken together.
struct ContactFrame {
    int32_t a = -1;  ///< bodies: those of the scene first, then the proxies, in order
    int32_t b = -1;
    int32_t points = 0;
    Vec3 p_WC = Vec3::Zero();  ///< centre of pressure; without pressure, the mean of the points
    Vec3 n_W = Vec3::Zero();   ///< mean normal, from a to b
    double gap = 0;            ///< smallest distance; negative: penetration
    double normal_force = 0;
    Vec3 f_B_W = Vec3::Zero();  ///< total force on b

    template <class Self, class Visitor>
    static void visit(Self& c, Visitor& v) {
        v("body_a", c.a, "1");
        v("body_b", c.b, "1");
        v("points", c.points, "1");
        v("position", c.p_WC, "m");
        v("normal", c.n_W, "1");
        v("gap", c.gap, "m");
        v("normal_force", c.normal_force, "N");
        v("force_on_b", c.f_B_W, "N");
    }
};

struct Frame {
    int64_t sequence = 0;
    Time time{0};  ///< of the tick, since activation
    int32_t trial = 0;
    int32_t phase = 0;  ///< of the trial: index into the driver's or the task's list
    uint32_t status = 0;
    double grip_force = kUnmeasured;  ///< pinch part of the normal forces, half their sum over the
                                      ///< digits; NaN for one finger
    double load_force = 0;  ///< tangential contact forces along gravity, summed over the fingers
    int32_t coupling = 0;   ///< in force: index into haptics::CouplingKind
    double stiffness = 0;   ///< k in force
    double damping = 0;     ///< c in force; NaN: k h / 2
    double smoothing = 0;   ///< alpha in force
    int32_t proxy = 0;      ///< haptics::ProxyKind in force, for fingers without their own
    double friction_scale = 1;  ///< in force, for every coefficient of friction
    double workspace_turn = 0;  ///< angle of WorkspaceTurn in this tick [rad]
    double workspace_rate = 0;  ///< rate of that angle until the next tick [rad/s]
    int32_t solver = 0;         ///< solver asked for: index into dynamics::Solver
    int32_t solver_iterations = 0;
    int32_t solver_fallback = 0;         ///< 1: another solver answered
    int32_t solver_route = 0;            ///< how the answer was found: index into contact::Route
    double solver_residual = 0;          ///< natural map of Coulomb's law over 1 + |q|
    double lateness = kUnmeasured;       ///< of this tick's wake-up; NaN on the virtual clock
    double tick_duration = kUnmeasured;  ///< of the last tick; NaN on the virtual clock
    TaskFrame task;
    std::vector<FingerFrame> fingers;
    std::vector<TurnFrame> turns;   ///< of fingers whose devices measure orientation, in order
    std::vector<BodyFrame> bodies;  ///< of the scene
    std::vector<uint16_t>
        changed;  ///< bodies that changed since the last frame; only these are logged
    std::vector<ContactFrame> contacts;

    /// Calls v(name, value, unit) for values; for lists, v.each(name, list) and v.changed(name,
    /// list, which).
    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("sequence", f.sequence, "1");
        v("time", f.time, "ns");
        v("trial", f.trial, "1");
        v("phase", f.phase, "1");
        v("status", f.status, "1");
        v("grip_force", f.grip_force, "N");
        v("load_force", f.load_force, "N");
        v("coupling", f.coupling, "1");
        v("stiffness", f.stiffness, "N/m");
        v("damping", f.damping, "N*s/m");
        v("smoothing", f.smoothing, "1");
        v("proxy", f.proxy, "1");
        v("friction_scale", f.friction_scale, "1");
        v("workspace_turn", f.workspace_turn, "rad");
        v("workspace_rate", f.workspace_rate, "rad/s");
        v("solver", f.solver, "1");
        v("solver_iterations", f.solver_iterations, "1");
        v("solver_fallback", f.solver_fallback, "1");
        v("solver_route", f.solver_route, "1");
        v("solver_residual", f.solver_residual, "1");
        v("lateness", f.lateness, "s");
        v("tick_duration", f.tick_duration, "s");
        TaskFrame::visit(f.task, v);
        v.each("fingers", f.fingers);
        v.each("turns", f.turns);
        v.changed("bodies", f.bodies, f.changed);
        v.each("contacts", f.contacts);
    }
};

}  // namespace dihaptic::servo
