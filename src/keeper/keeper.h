// The keeper: a process of its own that owns real devices, so that somebody is there to take force
// away when the program that uses them dies, stops or hangs.
//
// It does what the program asks, over a socket outside of the cycle and over a shared page in it,
// and puts every device to zero when the program says so, when its socket closes, or when it has
// been silent for longer than it said it would be. README.md has the times.
#pragma once

#include <functional>

namespace dihaptic::keeper {

/// What the keeper inherits from the program that started it: file descriptors.
constexpr int kSocket = 3;
constexpr int kMemory = 4;

/// Runs `body` in the calling thread with what real time takes; `priority`: SCHED_FIFO's.
using InRealTime = std::function<void(int priority, const std::function<void()>& body)>;

/// Serves until the program is gone. Returns what the process is to return.
int keep(const InRealTime& in_real_time);

}  // namespace dihaptic::keeper
