// Orders, tick by tick, how a task's things are shown: hidden, coloured, sized, late, shaken or
// held where they were. What it orders is recorded (frame/task_frame.h), so that a replay and a
// picture show what the person saw. Once constructed it neither allocates, locks nor throws.
#pragma once

#include "base/random.h"
#include "task/plan/task_plan.h"

namespace dihaptic::task {

class Displayer {
  public:
    /// `plan` must outlive the object. `seed`: of the noise.
    Displayer(const TaskPlan& plan, uint64_t seed, double tick);

    /// Call in each tick before the other functions, with the last Frame: its poses are what is
    /// shown later.
    void see(const frame::Frame& last) noexcept;
    /// A state begins, in a new trial or in the one that runs. How it shows things holds until the
    /// next begins, between trials too.
    void enter(const TaskPlan::Stage& stage, const TaskPlan::Cell& cell, bool new_trial) noexcept;
    /// Call after the task's own orders, which name the targets and the visual map.
    void order(double now, frame::TaskFrame& out) noexcept;

  private:
    /// The pose by the visual map `ticks` ago.
    const Pose& past(size_t thing, long ticks) const noexcept;
    void displace(const frame::VisualMap& map, frame::TaskFrame& out) const noexcept;

    size_t fingers_;
    int object_;  // -1: none
    double tick_;
    Random random_;
    Vec3 shake_ = Vec3::Zero();  // of unit standard deviation
    double shaken_ = -1;         // when it was drawn [s]
    size_t things_;              // the fingers, then the object
    size_t bodies_ = 0;          // of the scene
    size_t rows_;
    std::vector<Pose> past_;  // a ring of rows with a pose of each thing
    size_t newest_ = 0;       // row
    size_t seen_ = 0;         // number of rows that are filled
    const TaskPlan::Stage* stage_ = nullptr;
    const TaskPlan::Cell* cell_ = nullptr;
    bool holds_ = false;
    std::vector<Pose> held_;  // by finger
};

}  // namespace dihaptic::task
