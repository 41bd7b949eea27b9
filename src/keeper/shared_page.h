// The memory that the program and the keeper share: what each tick passes between them, and the
// word that takes force away.
//
// The program asks, and the keeper answers; while devices pace, it is the keeper that offers a
// turn, and the program that replies. Each counts in words of its own, and the other sleeps on them
// (a futex). Either may die at any moment; nothing here is a lock.
#pragma once

#include <atomic>
#include <cstdint>

#include "devices/device_group.h"

namespace dihaptic::keeper {

constexpr size_t kMostDevices = 8;

enum class Request : uint32_t { read, write, pace, quit };

struct SharedPage {
    // of the program
    std::atomic<uint32_t> bell{0};     ///< rung with each change of the others: the keeper's alone
    std::atomic<uint32_t> asked{0};    ///< how many requests
    std::atomic<uint32_t> replied{0};  ///< how many turns had their forces
    std::atomic<uint32_t> ended{0};    ///< 1: no force any more, whatever is asked
    std::atomic<uint32_t> closing{0};  ///< 1: pacing is to end
    Request request{};
    int64_t now = 0;  ///< of a reading [ns]
    Wrench wrenches[kMostDevices];

    // of the keeper
    std::atomic<uint32_t> answered{0};
    std::atomic<uint32_t> offered{0};  ///< turns, while devices pace
    std::atomic<uint32_t> off{0};      ///< 1: since `ended` no force is on any device
    devices::Reading readings[kMostDevices];
};
static_assert(std::atomic<uint32_t>::is_always_lock_free);
static_assert(sizeof(std::atomic<uint32_t>) == sizeof(uint32_t));

/// No force any more: sets `ended`, and wakes the keeper. Async-signal-safe.
void end_force(SharedPage& page) noexcept;
/// Sleeps until `word` is not `old` any more, somebody wakes it, or `most` has passed; the caller
/// looks again. Allocates nothing.
void wait_on(const std::atomic<uint32_t>& word, uint32_t old, Time most) noexcept;
/// Wakes who waits on it, in either process. Async-signal-safe.
void wake(std::atomic<uint32_t>& word) noexcept;
/// One more, and wakes who waits for it.
void advance(std::atomic<uint32_t>& word) noexcept;
/// Waits for `word` to become something else than `old`; false when `most` has passed first. `hope`
/// is how long it looks without sleeping, for what is about to come.
bool await_change(const std::atomic<uint32_t>& word, uint32_t old, Time most,
                  Time hope = Time(0)) noexcept;
/// Nanoseconds of CLOCK_MONOTONIC. Async-signal-safe.
int64_t monotonic() noexcept;

}  // namespace dihaptic::keeper
