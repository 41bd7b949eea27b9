// What becomes of a tick that came late: faults, softer couplings, and a bound on what forces rise
// by. haptics/late_loop.h has the equations.
#include <algorithm>

#include "haptics/late_loop.h"
#include "servo/servo.h"

namespace dihaptic::servo {

/// What is no fault, with simulated devices alone, is told all the same.
void Servo::judge_lateness(Time now, double elapsed) noexcept {
    late_.tick(now, from_seconds(elapsed));
    elapsed_ = elapsed;
    lateness_fault_ = {};
    late_told_ = 0;
    const double overdue = std::max(elapsed - settings_.tick(), lateness_);
    const double pause = settings_.safety.max_pause;
    const double most = settings_.safety.max_late.value_or(pause);
    // a clock that goes back says nothing of how long the last force was held
    if (elapsed > pause || elapsed < 0) {
        lateness_fault_ = {haptics::FaultKind::late, -1, now, elapsed, pause};
        late_told_ = kLate;
    } else if (frame_.sequence >= 0 && settings_.safety.max_late && overdue > most) {
        lateness_fault_ = {haptics::FaultKind::late, -1, now, overdue, most};
        late_told_ = kLate;
    } else if (haptics::held_stiffness(damping_, late_.sustained()) < haptics::kLeastHeld) {
        lateness_fault_ = {haptics::FaultKind::keeps_late, -1, now,
                           settings_.tick() + late_.sustained(), haptics::kLeastHeld};
        late_told_ = kKeepsLate;
    }
}

void Servo::retune() noexcept {
    haptics::CouplingSettings next = settings_.coupling;
    if (real_) next = haptics::softened(next, damping_, late_.sustained(), settings_.tick());
    if (next.tuning() == in_force_.tuning() && next.turn_stiffness == in_force_.turn_stiffness)
        return;
    in_force_ = next;
    for (haptics::Finger& finger : fingers_) finger.retune(in_force_);
}

/// Until lateness that has just begun has softened the couplings, and for the wall and the fields:
/// the force of the last tick may go on as a spring that the loop holds.
void Servo::bound_rise(size_t finger, double share) noexcept {
    if (!real_ || late_.expected() <= 0 || share <= 0) return;
    Force& force = forces_[finger];
    const Move& move = moves_[finger];
    const double k = haptics::held_stiffness(damping_, late_.expected());
    const double turn_k = haptics::kTurnHeld * k;
    const Wrench asked = force.felt_0;
    // no stiffer than the coupling, which is bounded by little then; it is let go by the creep
    force.felt_0.force =
        haptics::bound_rise(asked.force, force.last_0.force / share, move.way,
                            std::min(k, in_force_.stiffness), k * haptics::kCreep * elapsed_);
    force.felt_0.torque = haptics::bound_rise(asked.torque, force.last_0.torque / share, move.turn,
                                              std::min(turn_k, in_force_.turn_stiffness),
                                              turn_k * haptics::kTurnCreep * elapsed_);
    if (force.felt_0.force != asked.force || force.felt_0.torque != asked.torque)
        force.flags |= haptics::kRiseBounded;
}

}  // namespace dihaptic::servo
