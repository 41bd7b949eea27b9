// What comes before a block: a break, then pages of text and pictures. In the tick it neither
// allocates, locks nor throws.
#pragma once

#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Makes the pictures of the task's pages relative to the program's folder instead of `folder`; a
/// picture that is missing or no PNG file goes to `diagnostics`.
void find_pictures(Task& task, const std::string& folder, Diagnostics& diagnostics);

/// Longest time that the breaks and timed pages before a block last [s].
double longest_opening(const TaskPlan& plan) noexcept;

class Opening {
  public:
    /// `plan` must outlive the object.
    explicit Opening(const TaskPlan& plan) : plan_(plan) {}

    /// Whether the trial may begin, as far as its block's opening goes. Call in each tick before
    /// the trial. `rests`: the block's break counts; `key`: pressed since the last tick, or 0.
    bool over(const Trial& next, bool rests, char key, double now) noexcept;
    /// Whether an opening is on: its trial is the next one.
    bool on() const noexcept { return on_ != 0; }
    /// Index of the page that is shown; -1: none.
    int page() const noexcept;
    /// Time that is left of the break; negative if there is none [s].
    double rest_left(double now) const noexcept;

  private:
    const TaskPlan::Opening& of_block() const noexcept {
        return plan_.openings[static_cast<size_t>(block_)];
    }

    const TaskPlan& plan_;
    int opened_ = 0;  // number of the last block that was opened, from 1
    int on_ = 0;      // number of the block that is being opened; 0: none
    int block_ = 0;   // index of its kind among the task's blocks
    int at_ = -1;     // page among the block's; -1: the break
    double since_ = 0;
};

}  // namespace dihaptic::task
