// Orders the display of a task's things in each tick: hidden, coloured, scaled, delayed, with
// noise, or held in place. The orders are recorded (frame/task_frame.h), so that a replay and a
// picture match the person's view. Once constructed, it neither allocates, locks nor throws.
#pragma once

#include "base/random.h"
#include "task/plan/task_plan.h"

namespace dihaptic::task {

class Displayer {
  public:
    /// `plan` must outlive the object. `seed`: for the noise.
    Displayer(const TaskPlan& plan, uint64_t seed, double tick);

    /// Call in each tick before the other functions, with the last Frame, whose poses are stored
    /// for delayed display.
    void see(const frame::Frame& last) noexcept;
    /// Starts a state, in a new trial or in the running one. Its display applies until the next
    /// state starts, also between trials.
    void enter(int state, const TaskPlan::Looks& looks, bool new_trial) noexcept;
    /// Call after the task's own orders, which contain the targets and the visual map.
    void order(double now, frame::TaskFrame& out) noexcept;

  private:
    /// The pose that the visual map gave `ticks` ticks ago.
    const Pose& past(size_t thing, long ticks) const noexcept;
    void displace(const frame::VisualMap& map, frame::TaskFrame& out) const noexcept;

    const TaskPlan& plan_;
    size_t fingers_;
    int object_;  // -1: none
    double tick_;
    Random random_;
    Vec3 shake_ = Vec3::Zero();  // noise with unit standard deviation
    double shaken_ = -1;         // time of the last draw [s]
    size_t things_;              // number of things: the fingers, then the object
    size_t bodies_ = 0;          // number in the scene
    size_t rows_;
    std::vector<Pose> past_;  // a ring buffer of rows with one pose per thing
    size_t newest_ = 0;       // row
    size_t seen_ = 0;         // number of filled rows
    int state_ = -1;
    const TaskPlan::Looks* looks_ = nullptr;  // looks of the condition
    bool holds_ = false;
    std::vector<Pose> held_;       // by finger
    std::vector<Pose> ended_;      // by state and finger: displayed pose when the state ended
    std::vector<char> has_ended_;  // by state: whether it has ended in this trial
};

}  // namespace dihaptic::task
