// Sets a session's phase according to time alone.
#pragma once

#include <vector>

#include "recording/setup.h"
#include "servo/servo.h"

namespace dihaptic::session {

/// The director of sessions without a task: the driver defines the times of the phases.
class PhaseDirector {
  public:
    PhaseDirector(std::vector<recording::PhaseInfo> phases, double tick)
        : phases_(std::move(phases)), tick_(tick) {}

    void operator()(const frame::Frame& last, std::span<const frame::Handle>,
                    frame::Commands& commands) noexcept {
        const double now = last.sequence < 0 ? 0 : seconds(last.time) + tick_;
        while (phase_ + 1 < phases_.size() && now >= phases_[phase_].end - tick_ / 2) ++phase_;
        commands.trial = 1;
        commands.phase = static_cast<int32_t>(phase_);
    }

  private:
    std::vector<recording::PhaseInfo> phases_;
    double tick_;
    size_t phase_ = 0;
};

}  // namespace dihaptic::session
