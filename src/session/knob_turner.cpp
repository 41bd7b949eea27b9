#include "session/knob_turner.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace dihaptic::session {

void KnobTurner::prepare(const servo::Servo& servo, const scene::Scene& scene) {
    clearance_ = task::Clearance(scene);
    changeable_ = servo.settings().proxy.changeable;
}

void KnobTurner::turn(const frame::Frame& last, double h, frame::Knobs& now) noexcept {
    using frame::Knobs;
    const std::optional<Knobs>& wanted = wanted_.read();
    if (!wanted) return;
    bool anew = false;
    Knobs::visit([&](auto knob, const frame::Knob& is) {
        anew = anew || (is.eased && !Knobs::same(goal_.*knob, (*wanted).*knob));
    });
    goal_ = *wanted;
    if (anew) left_ = kEase;
    // moving by this share of the remaining change in each tick gives a straight line that ends on
    // time
    const double share = left_ > h ? h / left_ : 1;
    left_ = std::max(0.0, left_ - h);
    Knobs next = goal_;
    Knobs::visit([&]<class T>(T Knobs::*knob, const frame::Knob& is) {
        if constexpr (std::is_same_v<T, double>) {
            const double eased = now.*knob + share * (goal_.*knob - now.*knob);
            if (is.eased && share < 1 && !std::isnan(eased)) next.*knob = eased;
        }
    });
    const bool may_change = changeable_ && last.sequence >= 0;
    if (next.proxy != now.proxy && !(may_change && clearance_.all_clear(last)))
        next.proxy = now.proxy;
    next.workspace_rate = servo::WorkspaceTurn::rate_toward(
        goal_.workspace_turn, last.workspace_turn + h * last.workspace_rate);
    now = next;
}

}  // namespace dihaptic::session
