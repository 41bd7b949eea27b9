#include "rig/guided_steps.h"

#include <utility>

namespace dihaptic::rig {

void GuidedSteps::sample(const std::function<bool(bool said)>& each) {
    bool said = false;
    int64_t ticks = 0;
    constexpr int64_t kTicks = kEvery / DeviceReader::kTick;
    reader_.repeat([&] {
        said = guide_.done() || said;
        if (++ticks % kTicks != 0) return true;
        return each(std::exchange(said, false));
    });
}

}  // namespace dihaptic::rig
