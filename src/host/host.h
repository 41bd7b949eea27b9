// The device host: a separate process that owns real devices and switches the force off when the
// program that uses them dies, stops or hangs.
//
// The device host serves the program's requests, over a socket outside the cycle and over a shared
// page in it. It sets the force of every device to zero at the program's request, when the
// program's socket closes, or when the program has been silent for longer than agreed. README.md
// has the times.
#pragma once

#include <functional>

namespace dihaptic::host {

/// File descriptors that the device host inherits from the program that started it.
constexpr int kSocket = 3;
constexpr int kMemory = 4;

/// Runs `body` in the calling thread, set up for real time; `priority`: for SCHED_FIFO.
using InRealTime = std::function<void(int priority, const std::function<void()>& body)>;

/// Serves until the program has ended. Returns the exit status of the process.
int keep(const InRealTime& in_real_time);

}  // namespace dihaptic::host
