#include "task/run/sounder.h"

#include <utility>

namespace dihaptic::task {

void Sounder::order(const TaskPlan::PlannedState* planned, frame::TaskFrame& out) noexcept {
    const uint32_t wanted =
        plan_.throughout | (planned == nullptr ? 0 : planned->sounds & plan_.going_on);
    const uint32_t before = std::exchange(going_, wanted);
    const uint32_t begin = std::exchange(once_, 0) | (wanted & ~before);
    const uint32_t end = before & ~wanted;
    for (int i = 0; begin >> i != 0 && i < TaskPlan::kMostSounds; ++i) {
        if ((begin >> i & 1u) != 0) add(out.sounds, {i, 1});
    }
    for (int i = 0; end >> i != 0 && i < TaskPlan::kMostSounds; ++i) {
        if ((end >> i & 1u) != 0) add(out.sounds, {i, 0});
    }
}

}  // namespace dihaptic::task
