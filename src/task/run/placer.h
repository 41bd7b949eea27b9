// Places the bodies of a task at the start of a trial and in its states, as soon as no finger is in
// the way, and drives bodies and joints.
#pragma once

#include <vector>

#include "frame/orders.h"
#include "task/effects/load/motions.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::task {

class Placer {
  public:
    /// `plan` must outlive this object.
    explicit Placer(const TaskPlan& plan);

    /// What keeps a body from being placed at its start pose.
    struct Obstacle {
        int body = -1;    ///< index of the body; -1 if there has been no obstacle so far
        int finger = -1;  ///< index of the finger in the way; -1 if a finger presses the body
    };
    Obstacle obstacle() const noexcept { return obstacle_; }

    /// Placements that did not take place, since a finger was in the way until their state ended.
    struct Missed {
        int count = 0;
        // the last of them
        int trial = 0;  ///< number of the trial, counted from 1
        int state = -1;
        int body = -1;
    };
    const Missed& missed() const noexcept { return missed_; }

    /// Whether all bodies of the trial can be returned to their start poses.
    bool is_clear(const frame::Frame& last, const TaskPlan::Cell& cell) noexcept;
    /// Returns the trial's bodies to their start poses, except those that are there.
    void begin(const frame::Frame& last, const TaskPlan::Cell& cell, Motions& motions,
               frame::Commands& commands) noexcept;
    /// To be called when a state is entered.
    void enter() noexcept;
    /// To be called when a state is left. `trial`: number of the trial, counted from 1.
    void leave(const TaskPlan::PlannedState& planned, int state, int trial) noexcept;
    /// Commands the placements, drives and motors of a state. `t`: time in the state at the end of
    /// the tick [s].
    void order(const TaskPlan::PlannedState& state, const frame::Frame& last, double t,
               const TrialNumbers& numbers, Motions& motions, frame::Commands& commands) noexcept;

  private:
    bool is_clear(const frame::Frame& last, const TaskPlan::StartPose& start_pose,
                  const Pose& X_WB) noexcept;
    void put_bodies(const TaskPlan::PlannedState& state, const frame::Frame& last,
                    const TrialNumbers& numbers, Motions& motions,
                    frame::Commands& commands) noexcept;
    void drive(const TaskPlan::PlannedState& state, const frame::Frame& last, double t,
               const TrialNumbers& numbers, frame::Commands& commands) noexcept;

    const TaskPlan& plan_;
    std::vector<char> is_put_;  // for each placement in the state, whether the body has been placed
    std::vector<Pose> put_at_;  // for each placement, the pose of its body
    // for each drive, the pose of its body at the start of the state
    std::vector<Pose> drive_from_;
    // for each motor, the coordinate of its joint at the start of the state
    std::vector<double> motor_from_;
    bool driving_ = false;  // whether drive_from_ and motor_from_ are valid for this state
    Obstacle obstacle_;
    Missed missed_;
};

}  // namespace dihaptic::task
