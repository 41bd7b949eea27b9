#include "session/wait.h"

#include <fmt/format.h>

#include <algorithm>

#include "task/run/opening.h"

namespace dihaptic::session {

Wait::Wait(const task::TaskPlan& plan)
    : bounds_{kLongestBetween + task::longest_opening(plan)}, attempt_bound_(bounds_.front()) {
    for (const task::TaskPlan::PlannedState& planned : plan.states) {
        double longest = 0;
        for (const task::TaskPlan::Transition& transition : planned.transitions) {
            if (transition.exit.when == task::When::time)
                longest = std::max(longest, plan.largest(transition.exit.hold));
        }
        bounds_.push_back(longest + kLongest);
        attempt_bound_ += kRounds * bounds_.back();
    }
}

void Wait::look(const frame::Frame& last, const frame::Commands& commands) noexcept {
    const double now = seconds(last.time);
    if (last.trial != trial_ || last.task.attempt != attempt_) begun_ = since_ = now;
    if (last.phase != phase_) since_ = now;
    trial_ = last.trial;
    attempt_ = last.task.attempt;
    phase_ = last.phase;
    seen_ = now;
    const bool same = commands.trial == trial_ && commands.phase == phase_;
    over_ = (same && now - since_ > bounds_[static_cast<size_t>(phase_)]) ||
            now - begun_ > attempt_bound_;
}

std::string Wait::describe(const std::vector<recording::PhaseInfo>& phases,
                           const std::string& in_the_way) const {
    const auto i = static_cast<size_t>(phase_);
    return fmt::format(
        "The simulated hand never ended '{}' of trial {}: the session ends after {:.0f} s of "
        "waiting. {}",
        i < phases.size() ? phases[i].name : "a state", trial_, seen_ - since_,
        phase_ == task::kBetween
            ? "Its fingers stay where an object is put back: let the last state move them away, or "
              "list the object under 'stays'. " +
                  in_the_way
            : std::string("Give the state an exit by time, or the hand steps that reach an exit; "
                          "states that "
                          "lead back to each other need a way out."));
}

}  // namespace dihaptic::session
