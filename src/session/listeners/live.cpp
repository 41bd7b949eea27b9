#include "session/listeners/live.h"

#include <cmath>

#include "task/run/task_director.h"

namespace dihaptic::session {

void Live::prepare(const servo::Servo& servo, const scene::Scene& scene) {
    for (frame::Frame& value : frame.values()) servo.reserve(value);
    if (second) {
        for (frame::Frame& value : second->values()) servo.reserve(value);
    }
    object_ = scene.object_index();
    knobs.prepare(servo, scene);
}

/// Updates the wall-clock time at which session time was zero. Every tick is somewhat late, so the
/// earliest estimate is the best. A pause, during which session time stands still, moves the zero
/// to a later time.
void Live::note_zero(Time now) noexcept {
    constexpr Clock::rep kPause = std::chrono::nanoseconds(std::chrono::milliseconds(50)).count();
    const Clock::rep zero = (Clock::now().time_since_epoch() - now).count();
    const Clock::rep before = zero_.load(std::memory_order_relaxed);
    if (zero < before || zero - before > kPause) zero_.store(zero, std::memory_order_relaxed);
}

double Live::session_time(Clock::time_point at) const noexcept {
    return seconds(at.time_since_epoch() - Clock::duration(zero_.load(std::memory_order_relaxed)));
}

void Live::note_shown(int64_t tick, Clock::time_point at) noexcept {
    showings_.push({tick, session_time(at)});
}

void Live::note_shown(int64_t tick, Clock::time_point at, const Pose& X_WV, bool tracked) noexcept {
    if (tick != shown_tick_) note_shown(tick, at);  // during a pause, the same tick is shown again
    shown_tick_ = tick;
    const Vec3& p = X_WV.p;
    const Quat& R = X_WV.R;
    heads_.push(
        {tick, session_time(at), {p.x(), p.y(), p.z()}, {R.w(), R.x(), R.y(), R.z()}, tracked});
}

/// Reports an attempt in its last tick, the only tick that has the attempt's outcome.
void Live::note_trial(const frame::Frame& now) noexcept {
    if (now.trial < 1) return;
    if (now.trial != trial_.trial || now.task.attempt != trial_.attempt) {
        trial_ = {};
        trial_.trial = now.trial;
        trial_.attempt = now.task.attempt;
        trial_.start = seconds(now.time);
    }
    trial_.peak_grip = std::fmax(trial_.peak_grip, now.grip_force);
    for (const frame::FingerFrame& finger : now.fingers)
        trial_.peak_force = std::fmax(trial_.peak_force, finger.f_sent_W.norm());
    if (now.task.outcome < 0 || trial_.outcome >= 0) return;
    trial_.outcome = now.task.outcome;
    trial_.stop = seconds(now.time);
    const auto& variables = now.task.variables;
    for (size_t i = 0; i < TrialEnd::kNumbers; ++i)
        trial_.numbers[i] = i < variables.size() ? variables[i].value : kUnmeasured;
    trial_ends_.push(trial_);
}

void Live::steer(const Steering& steering) noexcept {
    frame::Commands& commands = steering.commands;
    commands.rest = steering.real && paused.load(std::memory_order_relaxed);
    commands.abandoned = steering.real ? abandoned() : 0;
    knobs.turn(steering.last, seconds(steering.period), commands.knobs);
    if (steering.task == nullptr) return;
    if (skip.exchange(false, std::memory_order_relaxed)) steering.task->skip();
    const task::Click click = clicked.exchange(task::Click{}, std::memory_order_relaxed);
    if (click.item >= 0) steering.task->click(click);
    done.store(steering.task->share(), std::memory_order_relaxed);
}

void Live::take(const frame::Frame& now) noexcept {
    note_zero(now.time);
    note_trial(now);
    // in a pause, the operator requested this tick, so it is always shown
    if (now.sequence == 0 || now.time - shown_ >= kInterval || paused) {
        shown_ = now.time;
        frame.publish(now);
        if (second) second->publish(now);
    }
    if (now.sequence > 0 && now.time - sampled_ < kCurveInterval) return;
    sampled_ = now.time;
    CurveSample sample;
    sample.time = seconds(now.time);
    sample.grip_force = now.grip_force;
    sample.load_force = now.load_force;
    for (size_t i = 0; i < now.fingers.size() && i < CurveSample::kFingers; ++i) {
        sample.forces[i] = now.fingers[i].f_sent_W.norm();
        sample.heights[i] = now.fingers[i].p_WH.z();
    }
    if (object_ >= 0) sample.object_height = now.bodies[static_cast<size_t>(object_)].X_WB.p.z();
    samples_.push(sample);
}

double Live::abandoned() const noexcept {
    const Clock::rep last = alive_.load(std::memory_order_relaxed);
    if (last == kNever) return 0;
    const double silence = seconds(Clock::now().time_since_epoch() - Clock::duration(last));
    return silence > kLongestSilence ? silence : 0;
}

void Live::tell(const std::string& why) {
    const std::lock_guard lock(told_guard_);
    told_ = why;
    paused = true;
}

std::string Live::take_told() {
    const std::lock_guard lock(told_guard_);
    return std::exchange(told_, "");
}

void Live::set_folder(const std::string& folder) {
    const std::lock_guard lock(told_guard_);
    folder_ = folder;
}

bool Live::add_remark(recording::Remark remark) {
    const std::lock_guard lock(told_guard_);
    if (remarks_closed_) return false;
    remarks_.push_back(std::move(remark));
    return true;
}

std::vector<recording::Remark> Live::take_remarks(bool close) {
    const std::lock_guard lock(told_guard_);
    remarks_closed_ |= close;
    return std::exchange(remarks_, {});
}

std::string Live::take_folder() {
    const std::lock_guard lock(told_guard_);
    return std::exchange(folder_, {});
}

}  // namespace dihaptic::session
