// The memory shared by the program and the device host: the data of each tick, and the flag by
// which the program ends force.
//
// The program requests and the device host answers; while devices pace, the device host offers
// turns and the program replies. Each side has its own counters, on whose changes the other side
// sleeps (futex). Either side may die at any moment, so no locks are used here.
#pragma once

#include <atomic>
#include <cstdint>

#include "devices/device_group.h"

namespace dihaptic::host {

constexpr size_t kMostDevices = 8;

enum class Request : uint32_t { read, write, pace, quit };

struct SharedPage {
    // written by the program
    std::atomic<uint32_t> bell{
        0};  ///< advances with each change below; the device host sleeps on it
    std::atomic<uint32_t> asked{0};    ///< number of requests made
    std::atomic<uint32_t> replied{0};  ///< number of turns for which forces were given
    std::atomic<uint32_t> ended{0};    ///< 1 if there is to be no more force, whatever is requested
    std::atomic<uint32_t> closing{0};  ///< 1 if pacing must end
    /// Also written by the device host when it ends. Atomic, because the device host's threads
    /// access it without further synchronisation.
    std::atomic<Request> request{};
    /// Time of the newest request, from monotonic(). The device host needs it because it may have
    /// slept since then.
    std::atomic<int64_t> asked_at{0};
    int64_t now = 0;  ///< time of a reading [ns]
    Wrench wrenches[kMostDevices];

    // written by the device host
    std::atomic<uint32_t> answered{0};  ///< number of requests that have been answered
    std::atomic<uint32_t> offered{0};   ///< number of turns offered, for devices that pace
    std::atomic<uint32_t> off{0};       ///< 1 if no force has acted since `ended`
    devices::Reading readings[kMostDevices];
};
static_assert(std::atomic<uint32_t>::is_always_lock_free);
static_assert(std::atomic<Request>::is_always_lock_free);
static_assert(std::atomic<int64_t>::is_always_lock_free);
static_assert(sizeof(std::atomic<uint32_t>) == sizeof(uint32_t));

/// Ends force by setting `ended`, and wakes the device host. Async-signal-safe.
void end_force(SharedPage& page) noexcept;
/// Sleeps while `word` equals `old`, until woken or until `most` has passed. May also wake up for
/// no reason, so the caller must check the word again. Does not allocate.
void wait_on(const std::atomic<uint32_t>& word, uint32_t old, Time most) noexcept;
/// Wakes all threads in both processes that wait on `word`. Async-signal-safe.
void wake(std::atomic<uint32_t>& word) noexcept;
/// Increments `word` by one, and wakes all threads that wait on it.
void advance(std::atomic<uint32_t>& word) noexcept;
/// Waits until `word` differs from `old`. Returns false if `most` passes first. Polls for the time
/// `hope` before it sleeps, in case the change is imminent.
bool await_change(const std::atomic<uint32_t>& word, uint32_t old, Time most,
                  Time hope = Time(0)) noexcept;
/// The time on CLOCK_MONOTONIC, in nanoseconds. Async-signal-safe.
int64_t monotonic() noexcept;

}  // namespace dihaptic::host
