// Determines in each tick how the things of a task are displayed: hidden, coloured, scaled,
// delayed, with noise, or held in place. These commands are recorded (frame/task_frame.h), so that
// a replay and a picture match the person's view. After construction, Displayer does not allocate,
// lock or throw.
#pragma once

#include "base/random.h"
#include "task/plan/task_plan.h"

namespace dihaptic::task {

class Displayer {
  public:
    /// `plan` must outlive the displayer. `seed` is used for the noise.
    Displayer(const TaskPlan& plan, uint64_t seed, double tick);

    /// Must be called in each tick before the other functions. Stores the poses of the last Frame,
    /// for delayed display.
    void see(const frame::Frame& last) noexcept;
    /// Starts a state, in a new trial or in the running trial. Its display applies until the next
    /// state starts, including the time between trials.
    void enter(int state, const TaskPlan::Looks& looks, bool new_trial) noexcept;
    /// Adds the display commands to `out`. Must be called when `out` already contains the targets
    /// and the visual map.
    void order(double now, frame::TaskFrame& out) noexcept;

  private:
    /// Returns the pose that the thing had `ticks` ticks ago, after the visual map.
    const Pose& past(size_t thing, long ticks) const noexcept;
    void displace(const frame::VisualMap& map, frame::TaskFrame& out) const noexcept;

    const TaskPlan& plan_;
    size_t fingers_;
    int object_;  // -1 if there is none
    double tick_;
    Random random_;
    Vec3 shake_ = Vec3::Zero();  // current noise, with unit standard deviation
    double shaken_ = -1;         // time at which noise was last drawn [s]
    size_t things_;              // number of things: the fingers, followed by the object
    size_t bodies_ = 0;          // number of bodies in the scene
    size_t rows_;
    std::vector<Pose> past_;  // ring buffer of rows with one pose for each thing
    size_t newest_ = 0;       // index of the newest row
    size_t seen_ = 0;         // number of rows filled so far
    int state_ = -1;
    const TaskPlan::Looks* looks_ = nullptr;  // looks in the current condition
    bool holds_ = false;
    std::vector<Pose> held_;   // for each finger, the pose at which it is held
    std::vector<Pose> ended_;  // for each state and finger, the pose displayed when the state ended
    std::vector<char> has_ended_;  // for each state, whether it has ended in this trial
};

}  // namespace dihaptic::task
