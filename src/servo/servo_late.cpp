// Handles late ticks: reports faults, softens the couplings, and limits how fast forces may rise.
// The equations are in haptics/late_loop.h.
#include <algorithm>

#include "haptics/late_loop.h"
#include "servo/servo.h"

namespace dihaptic::servo {

/// If all devices are simulated, lateness is not a fault, but it is still reported.
void Servo::judge_lateness(Time now, double elapsed) noexcept {
    late_.tick(now, from_seconds(elapsed));
    elapsed_ = elapsed;
    lateness_fault_ = {};
    // the lateness is NaN unless the caller set it; std::max() then returns its first argument
    const double overdue = std::max(elapsed - settings_.tick(), timing_.lateness);
    const double pause = settings_.safety.max_pause;
    const std::optional<double>& most = settings_.safety.max_late;
    // if the clock moved backwards, it is unknown how long the last force was held
    if (elapsed > pause || elapsed < 0) {
        lateness_fault_ = {haptics::FaultKind::late, -1, now, elapsed, pause};
    } else if (frame_.sequence >= 0 && most && overdue > *most) {
        lateness_fault_ = {haptics::FaultKind::late, -1, now, overdue, *most};
    } else if (haptics::held_stiffness(damping_, late_.sustained()) < haptics::kLeastHeld) {
        lateness_fault_ = {haptics::FaultKind::keeps_late, -1, now,
                           settings_.tick() + late_.sustained(), haptics::kLeastHeld};
    }
}

void Servo::retune() noexcept {
    frame::CouplingSettings next = commands_.knobs.coupled(settings_.coupling);
    if (real_) next = haptics::softened(next, damping_, late_.sustained(), settings_.tick());
    if (next == in_force_) return;
    in_force_ = next;
    for (Loop& loop : loops_) loop.finger.retune(in_force_);
}

/// Limits how much the force may rise in a tick that may be late. Lateness that has just begun has
/// not yet softened the couplings, and lateness never softens the wall or the force fields.
/// Starting from its value in the last tick, the force may rise only as much as that of a spring
/// whose stiffness is the one allowed for the loop or the coupling's own, whichever is lower, plus
/// a slow creep that lets the force recover.
void Servo::bound_rise(size_t finger, double share) noexcept {
    if (!real_ || late_.expected() <= 0 || share <= 0) return;
    Force& force = loops_[finger].force;
    const Move& move = loops_[finger].move;
    const double k = haptics::held_stiffness(damping_, late_.expected());
    const double turn_k = haptics::kTurnHeld * k;
    const Wrench asked = force.felt_0;
    force.felt_0.force =
        haptics::bound_rise(asked.force, force.last_0.force / share, move.way,
                            std::min(k, in_force_.stiffness), k * haptics::kCreep * elapsed_);
    force.felt_0.torque = haptics::bound_rise(asked.torque, force.last_0.torque / share, move.turn,
                                              std::min(turn_k, in_force_.turn_stiffness),
                                              turn_k * haptics::kTurnCreep * elapsed_);
    if (force.felt_0.force != asked.force || force.felt_0.torque != asked.torque)
        force.status |= kSoftened;
}

}  // namespace dihaptic::servo
