// The device host: a separate process that owns real devices and switches the force off when the
// program that uses them crashes, stops or hangs.
//
// The device host serves the program's requests: those of the ticks through a shared page, and all
// others through a socket. It sets the force of every device to zero at the program's request, when
// the program's socket closes, or when the program has been silent for longer than agreed.
// README.md lists the times.
#pragma once

#include <functional>

namespace dihaptic::host {

/// File descriptors that the device host inherits from the program that started it.
constexpr int kSocket = 3;
constexpr int kMemory = 4;

/// Runs `body` in the calling thread after setting the thread up for real time; `priority` is the
/// SCHED_FIFO priority.
using InRealTime = std::function<void(int priority, const std::function<void()>& body)>;

/// Serves the program until it has ended. Returns the exit status of the process.
int keep(const InRealTime& in_real_time);

}  // namespace dihaptic::host
