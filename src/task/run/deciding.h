// Waits for the decision of a program about the next attempt, if there is such a program.
#pragma once

#include "task/run/trial_control.h"

namespace dihaptic::task {

class Deciding {
  public:
    /// `between` must outlive this object.
    void decide_by(TrialControl& between) noexcept { between_ = &between; }
    void ask(const Ended& ended, double now) noexcept {
        if (between_ == nullptr) return;
        between_->ask(ended);
        asked_ = true;
        until_ = now + between_->patience();
    }
    /// Whether the program has answered, or is too late. Calls `follow(decision)`, which returns
    /// whether the decision can be followed, if there is a new decision.
    template <class Follow>
    bool is_over(double now, const Follow& follow) noexcept {
        if (!asked_) return true;
        if (const Decision* const decision = between_->answer()) {
            if (!follow(*decision)) between_->note_refused();
        } else if (now < until_ && !between_->gone()) {
            return false;
        } else {
            between_->note_late();
        }
        asked_ = false;
        return true;
    }

  private:
    TrialControl* between_ = nullptr;
    bool asked_ = false;  // whether a decision has been asked for and is still awaited
    double until_ = 0;    // time until which the decision is awaited [s]
};

}  // namespace dihaptic::task
