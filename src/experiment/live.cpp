#include "experiment/live.h"

namespace dihaptic::experiment {

void Live::prepare(const servo::Servo& servo, const scene::Scene& scene) {
    for (servo::Frame& value : frame.values()) servo.reserve(value);
    object_ = scene.object_index();
    clearance_ = Clearance(scene);
}

std::optional<haptics::ProxyKind> Live::change_proxy(const servo::Frame& last) noexcept {
    const std::optional<haptics::ProxyKind>& wish = proxy.read();
    if (!wish || static_cast<int32_t>(*wish) == last.proxy || !clearance_.all_clear(last))
        return std::nullopt;
    return wish;
}

/// Every tick is somewhat late, so the earliest zero is the best estimate. A pause, in which
/// session time stands still, moves the zero.
void Live::note_zero(Time now) noexcept {
    constexpr Clock::rep kPause = std::chrono::nanoseconds(std::chrono::milliseconds(50)).count();
    const Clock::rep zero = (Clock::now().time_since_epoch() - now).count();
    const Clock::rep before = zero_.load(std::memory_order_relaxed);
    if (zero < before || zero - before > kPause) zero_.store(zero, std::memory_order_relaxed);
}

void Live::note_shown(int64_t tick, Clock::time_point at) noexcept {
    const Clock::rep zero = zero_.load(std::memory_order_relaxed);
    const Time since = at.time_since_epoch() - Clock::duration(zero);
    showings_.push({tick, seconds(since)});
}

void Live::show(const servo::Frame& now) noexcept {
    note_zero(now.time);
    if (now.sequence == 0 || now.time - shown_ >= kInterval) {
        shown_ = now.time;
        frame.publish(now);
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

std::optional<haptics::Tuning> Live::tune(const haptics::Tuning& now, double h) noexcept {
    const std::optional<haptics::Tuning>& goal = tuning.read();
    if (!goal || *goal == now) return std::nullopt;
    if (tuning_goal_ != *goal) {
        tuning_goal_ = *goal;
        left_ = kEase;
    }
    haptics::Tuning next = *goal;
    // this share of the remaining change in each tick gives a straight line that ends on time
    const double share = left_ > h ? h / left_ : 1;
    left_ -= h;
    next.stiffness = now.stiffness + share * (goal->stiffness - now.stiffness);
    if (goal->damping && now.damping)
        next.damping = *now.damping + share * (*goal->damping - *now.damping);
    if (share == 1) next = *goal;
    return next;
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

}  // namespace dihaptic::experiment
