#include "task/run/task_hand.h"

#include <algorithm>

#include "hand/places.h"
#include "model/minimum_jerk.h"

namespace dihaptic::task {

TaskHand::TaskHand(std::shared_ptr<const TaskPlan> plan, const hand::HandSpec& spec,
                   const std::vector<std::string>& fingers)
    : plan_(std::move(plan)), numbers_(*plan_), places_(hand::finger_places(spec, fingers)) {
    for (const hand::FingerPlace& place : places_)
        start_.push_back(
            {place.centre.value_or(spec.centre), place.aperture.value_or(spec.aperture)});
    for (const std::string& name : plan_->phases()) phases_.push_back({name, 0, 0});
    restart();
}

void TaskHand::restart() {
    numbers_.restart();
    trial_ = attempt_ = 0;
    phase_ = -1;
    step_ = 0;
    begun_ = 0;
    from_ = to_ = start_;
}

TaskHand::Posture TaskHand::posture(size_t finger, double t) const noexcept {
    const double share = model::minimum_jerk((t - begun_) / duration_).share;
    const Posture& from = from_[finger];
    const Posture& to = to_[finger];
    return {from.centre + share * (to.centre - from.centre),
            from.aperture + share * (to.aperture - from.aperture)};
}

hand::FingerTarget TaskHand::do_target(int finger, double t) const noexcept {
    const auto i = static_cast<size_t>(finger);
    const hand::FingerPlace& place = places_[i];
    const Posture now = posture(i, t);
    const double s = (t - begun_) / duration_;
    const double rate = s >= 0 && s < 1 ? model::minimum_jerk(s).rate / duration_ : 0;
    hand::FingerTarget target;
    target.p_WT = now.centre + place.offset + now.aperture / 2 * place.side;
    target.v_WT = rate * (to_[i].centre - from_[i].centre +
                          (to_[i].aperture - from_[i].aperture) / 2 * place.side);
    return target;
}

void TaskHand::do_see(const frame::Frame& frame) noexcept {
    const double now = seconds(frame.time);
    if (frame.phase != kBetween)
        numbers_.follow(frame.trial, frame.task.attempt, frame.task.variables, frame.phase - 1);
    // between trials, the hand still completes the steps that it has already started
    const bool between = frame.phase == kBetween || frame.trial < 1;
    const bool entered = !between && (frame.trial != trial_ || frame.phase != phase_ ||
                                      frame.task.attempt != attempt_);
    if (between && phase_ < 1) return;
    const auto& steps =
        plan_->states[static_cast<size_t>((between ? phase_ : frame.phase) - 1)].hand;
    if (entered) {
        trial_ = frame.trial;
        phase_ = frame.phase;
        attempt_ = frame.task.attempt;
        step_ = 0;
        if (!steps.empty()) begin_step(now);
        return;
    }
    if (step_ + 1 < steps.size() && now - begun_ >= duration_) {
        ++step_;
        begin_step(now);
    }
}

void TaskHand::begin_step(double now) noexcept {
    const TaskPlan::Step& next = plan_->states[static_cast<size_t>(phase_ - 1)].hand[step_];
    for (size_t i = 0; i < places_.size(); ++i) {
        to_[i] = from_[i] = posture(i, now);
        if (!next.moves(i)) continue;
        if (next.step.aperture) to_[i].aperture = numbers_.of(*next.step.aperture);
        if (const int region = next.step.reach.index; region >= 0)
            to_[i].centre = numbers_.cell().p_W[static_cast<size_t>(region)];
        to_[i].centre += numbers_.of(next.step.move);
    }
    begun_ = now;
    duration_ = numbers_.of(next.step.duration);
}

}  // namespace dihaptic::task
