#include "servo/late_guard.h"

#include <algorithm>
#include <limits>

#include "haptics/late_loop.h"

namespace dihaptic::servo {

LateGuard::LateGuard(const frame::Settings& settings)
    : safety_(settings.safety),
      tick_(settings.tick()),
      late_(from_seconds(settings.tick())),
      damping_(std::numeric_limits<double>::infinity()) {}

void LateGuard::add(const frame::DeviceInfo& device) {
    is_real_ = is_real_ || !device.simulated;
    damping_ = std::min(damping_, device.damping > 0 ? device.damping : haptics::kLooseDamping);
    if (safety_.hand_damping) damping_ = *safety_.hand_damping;
}

void LateGuard::judge(Time now, double elapsed, bool is_first) noexcept {
    late_.tick(now, from_seconds(elapsed));
    elapsed_ = elapsed;
    fault_ = {};
    // the lateness is NaN unless the caller set it; std::max() then returns its first argument
    const double overdue = std::max(elapsed - tick_, timing_.lateness);
    const double pause = safety_.max_pause;
    const std::optional<double>& most = safety_.max_late;
    // if the clock moved backwards, it is unknown how long the last force was held
    if (elapsed > pause || elapsed < 0) {
        fault_ = {haptics::FaultKind::late, -1, now, elapsed, pause};
    } else if (!is_first && most && overdue > *most) {
        fault_ = {haptics::FaultKind::late, -1, now, overdue, *most};
    } else if (haptics::held_stiffness(damping_, late_.sustained()) < haptics::kLeastHeld) {
        fault_ = {haptics::FaultKind::keeps_late, -1, now, tick_ + late_.sustained(),
                  haptics::kLeastHeld};
    }
}

frame::CouplingSettings LateGuard::softened(const frame::CouplingSettings& wanted) const noexcept {
    if (!is_real_) return wanted;
    return haptics::softened(wanted, damping_, late_.sustained(), tick_);
}

Wrench LateGuard::bounded(const Wrench& asked, const Wrench& last, const Move& move, double share,
                          const frame::CouplingSettings& coupling) const noexcept {
    if (!is_real_ || late_.expected() <= 0 || share <= 0) return asked;
    const double k = haptics::held_stiffness(damping_, late_.expected());
    const double turn_k = haptics::kTurnHeld * k;
    return {haptics::bound_rise(asked.force, last.force / share, move.way,
                                std::min(k, coupling.stiffness), k * haptics::kCreep * elapsed_),
            haptics::bound_rise(asked.torque, last.torque / share, move.turn,
                                std::min(turn_k, coupling.turn_stiffness),
                                turn_k * haptics::kTurnCreep * elapsed_)};
}

}  // namespace dihaptic::servo
