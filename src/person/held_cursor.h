// How a simulated person interprets a cursor that the display holds in place: the cursor shows
// where the hand was at an earlier time, and the person only feels how the hand has moved since
// then.
#pragma once

#include <algorithm>
#include <vector>

#include "task/plan/task_plan.h"

namespace dihaptic::person {

/// Follows the task states of an attempt.
class HeldCursor {
  public:
    /// A time [s] and the felt position of the hand at that time [m].
    struct Moment {
        double time = -1;  ///< negative if it did not occur in this attempt
        Vec3 felt = Vec3::Zero();
    };

    /// `states` must outlive this object.
    explicit HeldCursor(const std::vector<task::TaskPlan::PlannedState>& states)
        : states_(states), left_(states.size()) {}

    /// To be called when the person sees a new state. `state`: index of the state. `now`: the time
    /// when it began.
    void enter(int state, bool new_attempt, const Moment& now) noexcept {
        const bool held = is_held() && !new_attempt;
        if (new_attempt) {
            std::ranges::fill(left_, Moment{});
        } else if (state_ >= 0) {
            left_[static_cast<size_t>(state_)] = now;
        }
        state_ = state;
        if (!is_held()) return;
        const int from = states_[static_cast<size_t>(state)].held_from;
        if (from >= 0 && left_[static_cast<size_t>(from)].time >= 0) {
            shown_ = left_[static_cast<size_t>(from)];
        } else if (!held) {
            shown_ = now;
        }
    }

    bool is_held() const noexcept {
        return state_ >= 0 && states_[static_cast<size_t>(state_)].holds_cursor;
    }
    /// The time and hand position that a held cursor shows.
    const Moment& shown() const noexcept { return shown_; }

  private:
    const std::vector<task::TaskPlan::PlannedState>& states_;
    std::vector<Moment> left_;  // for each state, when the hand left it
    Moment shown_;
    int state_ = -1;
};

}  // namespace dihaptic::person
