// The opening of a block: a break, then pages of text and pictures. In the tick it neither
// allocates, locks nor throws.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Converts the paths of the pages' pictures from relative to `folder` to relative to the program's
/// folder. Pictures that are missing or are neither PNG nor GIF files go to `diagnostics`.
void find_pictures(Task& task, const std::string& folder, Diagnostics& diagnostics);

/// Longest duration of the break and timed pages before a block [s].
double longest_opening(const TaskPlan& plan) noexcept;

class Opening {
  public:
    /// `plan` must outlive the object.
    explicit Opening(const TaskPlan& plan) : plan_(plan) {}

    /// Whether the block's opening is over, so that the trial can start. Call in each tick before
    /// the trial. `rests`: the block's break takes place; `key`: pressed since the last tick, or 0.
    bool over(const Trial& next, bool rests, char key, double now) noexcept;
    /// Whether an opening is in progress; the trial after it is the next one.
    bool on() const noexcept { return on_ != 0; }
    /// Index of the current page; -1: none.
    int page() const noexcept;
    /// Time left in the break; negative if there is none [s].
    double rest_left(double now) const noexcept;

  private:
    const TaskPlan::Opening& of_block() const noexcept {
        return plan_.openings[static_cast<size_t>(block_)];
    }

    const TaskPlan& plan_;
    int opened_ = 0;  // number of the last block with a completed opening, from 1
    int on_ = 0;      // number of the block whose opening is in progress; 0: none
    int block_ = 0;   // index of that block in the task
    int at_ = -1;     // index of the block's current page; -1: the break
    double since_ = 0;
};

}  // namespace dihaptic::task
