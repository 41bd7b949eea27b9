#include "task/run/placer.h"

#include <algorithm>
#include <cmath>

#include "task/run/clearance.h"

namespace dihaptic::task {
namespace {

constexpr double kAtStart = 1e-6;  // tolerance for a body at its start pose [m], [rad], [m/s]

bool same_pose(const Pose& a, const Pose& b) noexcept {
    return (a.p - b.p).norm() < kAtStart && a.R.angularDistance(b.R) < kAtStart;
}

/// Whether a finger presses the body.
bool pressed(const frame::Frame& last, int body) noexcept {
    const auto bodies = static_cast<int>(last.bodies.size());
    return std::any_of(
        last.contacts.begin(), last.contacts.end(), [&](const frame::ContactFrame& contact) {
            const bool of_body = contact.a == body || contact.b == body;
            return contact.normal_force > 0 && of_body && std::max(contact.a, contact.b) >= bodies;
        });
}

/// Returns the pose at which the body is placed in this tick or, if it is not placed, its pose in
/// the last Frame.
Pose pose_of(int body, const frame::Frame& last, const frame::Commands& commands) noexcept {
    for (const frame::PlacementFrame& placed : commands.task.placements) {
        if (placed.body == body) return placed.X_WB;
    }
    return last.bodies[static_cast<size_t>(body)].X_WB;
}

/// Returns the coordinate of the joint.
double coordinate_of(int joint, const frame::Frame& last) noexcept {
    const frame::JointFrame& frame = last.joints[static_cast<size_t>(joint)];
    return std::isnan(frame.angle) ? frame.displacement : frame.angle;
}

/// Adds the placement of the body in this tick to the commands, replacing any earlier placement of
/// this body.
void put(int body, const Pose& X_WB, const BodyMotion& motion, Motions& motions,
         frame::Commands& commands) noexcept {
    std::vector<frame::PlacementFrame>& list = commands.task.placements;
    const auto same = std::find_if(list.begin(), list.end(),
                                   [&](const auto& placed) { return placed.body == body; });
    if (same == list.end()) {
        add(list, {body, X_WB, motion.v, motion.w});
    } else {
        *same = {body, X_WB, motion.v, motion.w};
    }
    motions.put(body, X_WB.p);
}

}  // namespace

Placer::Placer(const TaskPlan& plan) : plan_(plan) {
    size_t placements = 0;
    size_t drives = 0;
    size_t motors = 0;
    for (const TaskPlan::PlannedState& planned : plan.states) {
        placements = std::max(placements, planned.placements.size());
        drives = std::max(drives, planned.drives.size());
        motors = std::max(motors, planned.motors.size());
    }
    is_put_.assign(placements, 0);
    put_at_.resize(placements);
    drive_from_.resize(drives);
    motor_from_.resize(motors);
}

bool Placer::is_clear(const frame::Frame& last, const TaskPlan::Cell& cell) noexcept {
    return std::all_of(cell.start_poses.begin(), cell.start_poses.end(),
                       [&](const TaskPlan::StartPose& start_pose) {
                           return is_clear(last, start_pose, start_pose.X_WB);
                       });
}

/// Whether a body can be placed at X_WB. If it were placed onto a finger, it would push the finger
/// out; if it were removed from between fingers that press it, the fingers would collide.
bool Placer::is_clear(const frame::Frame& last, const TaskPlan::StartPose& start_pose,
                      const Pose& X_WB) noexcept {
    if (last.sequence < 0) return true;
    if (same_pose(last.bodies[static_cast<size_t>(start_pose.body)].X_WB, X_WB)) return true;
    obstacle_ = {start_pose.body, -1};
    if (pressed(last, start_pose.body)) return false;
    for (size_t i = 0; i < last.fingers.size(); ++i) {
        obstacle_.finger = static_cast<int>(i);
        if (in_the_way(X_WB, start_pose.box, last.fingers[i].p_WP, plan_.finger_radius[i]))
            return false;
    }
    obstacle_ = {};
    return true;
}

void Placer::begin(const frame::Frame& last, const TaskPlan::Cell& cell, Motions& motions,
                   frame::Commands& commands) noexcept {
    for (const TaskPlan::StartPose& start_pose : cell.start_poses) {
        const bool there =
            last.sequence >= 0 &&
            (same_pose(last.bodies[static_cast<size_t>(start_pose.body)].X_WB, start_pose.X_WB) &&
             last.bodies[static_cast<size_t>(start_pose.body)].v_WB.norm() < kAtStart &&
             start_pose.motion.v.isZero(0) && start_pose.motion.w.isZero(0));
        if (!there) put(start_pose.body, start_pose.X_WB, start_pose.motion, motions, commands);
    }
}

void Placer::enter() noexcept {
    std::fill(is_put_.begin(), is_put_.end(), 0);
    driving_ = false;
}

void Placer::leave(const TaskPlan::PlannedState& planned, int state, int trial) noexcept {
    for (size_t i = 0; i < planned.placements.size(); ++i) {
        if (is_put_[i] == 0)
            missed_ = {missed_.count + 1, trial, state, planned.placements[i].pose.body};
    }
}

void Placer::order(const TaskPlan::PlannedState& state, const frame::Frame& last, double t,
                   const TrialNumbers& numbers, Motions& motions,
                   frame::Commands& commands) noexcept {
    put_bodies(state, last, numbers, motions, commands);
    // before the first Frame, it is not known where bodies and joints are
    if (last.sequence >= 0) drive(state, last, t, numbers, commands);
}

/// Places each of the state's bodies as soon as no finger presses or obstructs the body, and keeps
/// held bodies in place.
void Placer::put_bodies(const TaskPlan::PlannedState& state, const frame::Frame& last,
                        const TrialNumbers& numbers, Motions& motions,
                        frame::Commands& commands) noexcept {
    for (size_t i = 0; i < state.placements.size(); ++i) {
        const TaskPlan::Placement& wanted = state.placements[i];
        const int body = wanted.pose.body;
        if (is_put_[i] && !wanted.stays) continue;
        if (!is_put_[i]) {
            const Pose X_WB{wanted.pose.X_WB.R, numbers.of(wanted.pose.position)};
            // before the first Frame, the positions of the fingers are not known
            if (wanted.moves && (last.sequence < 0 || !is_clear(last, wanted.pose, X_WB))) continue;
            is_put_[i] = 1;
            put_at_[i] = wanted.moves ? X_WB : pose_of(body, last, commands);
        }
        const BodyMotion motion{numbers.of(wanted.pose.velocity), Vec3::Zero()};
        put(body, put_at_[i], motion, motions, commands);
    }
}

/// Commands where the state's drives and motors should be at the end of the tick, relative to where
/// their bodies and joints were at the beginning of the state.
void Placer::drive(const TaskPlan::PlannedState& state, const frame::Frame& last, double t,
                   const TrialNumbers& numbers, frame::Commands& commands) noexcept {
    const auto& drives = state.drives;
    const auto& motors = state.motors;
    if (!driving_) {
        for (size_t i = 0; i < drives.size(); ++i)
            drive_from_[i] = pose_of(drives[i].body(), last, commands);
        for (size_t i = 0; i < motors.size(); ++i)
            motor_from_[i] = coordinate_of(motors[i].joint(), last);
        driving_ = true;
    }
    const auto of = [&](const Formula& number) { return numbers.of(number); };
    for (size_t i = 0; i < motors.size(); ++i)
        add(commands.task.motors, motors[i].at(t, motor_from_[i], of, numbers.values()));
    for (size_t i = 0; i < drives.size(); ++i) {
        const Pose X_WB = drives[i].at(t, drive_from_[i], of, numbers.values());
        add(commands.task.drives, {drives[i].body(), X_WB});
    }
}

}  // namespace dihaptic::task
