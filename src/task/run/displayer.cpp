#include "task/run/displayer.h"

#include <algorithm>
#include <cmath>

#include "frame/displayed.h"

namespace dihaptic::task {
namespace {

constexpr double kShake = 1.0 / 60;  // interval at which noise is drawn anew: one screen frame [s]

/// Returns the number of rows of the ring buffer that the longest delay requires.
size_t rows_of(const TaskPlan& plan, double tick) {
    double longest = 0;
    for (const TaskPlan::Cell& cell : plan.cells) {
        for (const Perturbation& perturbation : cell.perturbations)
            longest = std::max(longest, perturbation.longest_delay());
    }
    return static_cast<size_t>(std::max(1L, std::lround(longest / tick)));
}

/// Merges looks into the existing ones. The new looks override existing looks of the same thing.
void put_on(const std::vector<frame::LookFrame>& looks, frame::TaskFrame& out) noexcept {
    for (const frame::LookFrame& look : looks) {
        const auto there =
            std::find_if(out.looks.begin(), out.looks.end(),
                         [&](const frame::LookFrame& other) { return other.body == look.body; });
        if (there == out.looks.end()) {
            add(out.looks, look);
            continue;
        }
        there->hidden |= look.hidden;
        if (look.colour >= 0) there->colour = look.colour;
        there->scale *= look.scale;
    }
}

void put_on(const std::vector<frame::TargetFrame>& looks, frame::TaskFrame& out) noexcept {
    for (const frame::TargetFrame& look : looks) {
        for (frame::TargetFrame& target : out.targets) {
            if (target.region != look.region) continue;
            if (look.colour >= 0) target.colour = look.colour;
            target.radius *= look.radius;
        }
    }
}

}  // namespace

Displayer::Displayer(const TaskPlan& plan, uint64_t seed, double tick)
    : plan_(plan),
      fingers_(plan.finger_radius.size()),
      object_(plan.object),
      tick_(tick),
      random_(seed, "displayed noise"),
      things_(fingers_ + (object_ >= 0 ? 1 : 0)),
      rows_(rows_of(plan, tick)),
      past_(rows_ * things_),
      held_(fingers_),
      ended_(plan.states.size() * fingers_),
      has_ended_(plan.states.size()) {}

void Displayer::see(const frame::Frame& last) noexcept {
    if (last.sequence < 0) return;
    bodies_ = last.bodies.size();
    newest_ = (newest_ + 1) % rows_;
    seen_ = std::min(seen_ + 1, rows_);
    Pose* const row = &past_[newest_ * things_];
    for (size_t i = 0; i < fingers_; ++i) row[i] = frame::mapped_proxy(last, i);
    if (object_ >= 0) row[fingers_] = frame::mapped_body(last, static_cast<size_t>(object_));
}

void Displayer::enter(int state, const TaskPlan::Looks& looks, bool new_trial) noexcept {
    if (new_trial) {
        std::ranges::fill(has_ended_, 0);
    } else if (state_ >= 0 && seen_ > 0) {
        const auto left = static_cast<size_t>(state_);
        for (size_t i = 0; i < fingers_; ++i) ended_[left * fingers_ + i] = past(i, 1);
        has_ended_[left] = 1;
    }
    state_ = state;
    looks_ = &looks;
    const TaskPlan::PlannedState& planned = plan_.states[static_cast<size_t>(state)];
    const auto from = static_cast<size_t>(std::max(0, planned.held_from));
    if (planned.holds_cursor && planned.held_from >= 0 && has_ended_[from] != 0) {
        for (size_t i = 0; i < fingers_; ++i) held_[i] = ended_[from * fingers_ + i];
    } else if (planned.holds_cursor && (new_trial || !holds_)) {
        // if two consecutive states hold the cursor, it keeps its position
        for (size_t i = 0; i < fingers_; ++i) held_[i] = past(i, 1);
    }
    holds_ = planned.holds_cursor && seen_ > 0;
}

const Pose& Displayer::past(size_t thing, long ticks) const noexcept {
    const size_t back = std::clamp<size_t>(static_cast<size_t>(std::max(1L, ticks)), 1,
                                           std::max<size_t>(1, seen_)) -
                        1;
    return past_[(newest_ + rows_ - back) % rows_ * things_ + thing];
}

void Displayer::order(double now, frame::TaskFrame& out) noexcept {
    if (state_ < 0) return;
    const TaskPlan::PlannedState& planned = plan_.states[static_cast<size_t>(state_)];
    for (const TaskPlan::Looks* looks : {looks_, &planned.looks}) {
        put_on(looks->things, out);
        put_on(looks->targets, out);
        if (looks->hidden_targets == 0) continue;
        std::erase_if(out.targets, [&](const frame::TargetFrame& target) {
            return (looks->hidden_targets >> target.region & 1u) != 0;
        });
    }
    if (!out.visual.empty() && seen_ > 0) {
        const frame::VisualMap& map = out.visual.front();
        const bool shakes = !map.noise.isZero(0);
        if (shakes && (shaken_ < 0 || now - shaken_ >= kShake - tick_ / 2)) {
            shake_ = Vec3(random_.normal(), random_.normal(), random_.normal());
            shaken_ = now;
        }
        if (shakes || map.delay > 0) displace(map, out);
    }
    if (!holds_) return;
    const auto is_finger = [&](const frame::DisplacedFrame& displaced) {
        return displaced.body >= static_cast<int32_t>(bodies_);
    };
    out.displaced.erase(std::remove_if(out.displaced.begin(), out.displaced.end(), is_finger),
                        out.displaced.end());
    for (size_t i = 0; i < fingers_; ++i)
        add(out.displaced, {static_cast<int32_t>(bodies_ + i), held_[i]});
}

/// Displaces the displayed objects. Objects with noise but no delay are shown one tick late,
/// because their poses in this tick are not known yet.
void Displayer::displace(const frame::VisualMap& map, frame::TaskFrame& out) const noexcept {
    const long ticks = std::lround(map.delay / tick_);
    const auto show = [&](size_t thing, size_t body) {
        Pose X_WB = past(thing, ticks);
        X_WB.p += map.noise.cwiseProduct(shake_);
        add(out.displaced, {static_cast<int32_t>(body), X_WB});
    };
    if ((map.moves & frame::kMovesProxies) != 0) {
        for (size_t i = 0; i < fingers_; ++i) show(i, bodies_ + i);
    }
    if ((map.moves & frame::kMovesObject) != 0 && object_ >= 0)
        show(fingers_, static_cast<size_t>(object_));
}

}  // namespace dihaptic::task
