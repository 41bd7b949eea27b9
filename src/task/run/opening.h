// The opening of a block: a break, then pages of text and pictures. During a tick, it does not
// allocate, lock or throw.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Makes the paths of the pages' pictures, which are relative to `folder`, relative to the
/// program's folder. Pictures that are missing, or are neither PNG nor GIF files, are reported to
/// `diagnostics`.
void find_pictures(Task& task, const std::string& folder, Diagnostics& diagnostics);

/// Returns the longest total duration of the break and the timed pages before a block [s].
double longest_opening(const TaskPlan& plan) noexcept;

class Opening {
  public:
    /// `plan` must outlive this object.
    explicit Opening(const TaskPlan& plan) : plan_(plan) {}

    /// Whether the block's opening is over, so that the trial can start. Must be called in each
    /// tick before the trial. `rests` tells whether the block's break takes place; `key` is the key
    /// pressed since the last tick, or 0.
    bool over(const Trial& next, bool rests, char key, double now) noexcept;
    /// Whether an opening is in progress. If so, the trial that follows it is the next trial.
    bool on() const noexcept { return on_ != 0; }
    /// Index of the current page, or -1 if no page is shown.
    int page() const noexcept;
    /// Time left in the break [s]; negative if there is no break.
    double rest_left(double now) const noexcept;

  private:
    const TaskPlan::Opening& of_block() const noexcept {
        return plan_.openings[static_cast<size_t>(block_)];
    }

    const TaskPlan& plan_;
    int opened_ = 0;  // number of the last block whose opening is complete, counted from 1
    int on_ = 0;      // number of the block whose opening is in progress; 0 for none
    int block_ = 0;   // index in the task of the block whose opening is in progress
    int at_ = -1;     // index of the block's current page; -1 during the break
    double since_ = 0;
};

}  // namespace dihaptic::task
