// The memory that the program and the device host share: the data of each tick, and the
// flag by which the program ends force.
//
// The program requests and the device host answers; while devices pace, the device host offers
// turns and the program replies. Each side counts in its own words, on which the other side sleeps
// (futex). Either side may die at any moment, so there is no lock here.
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
    std::atomic<uint32_t> asked{0};    ///< number of requests
    std::atomic<uint32_t> replied{0};  ///< number of turns whose forces were given
    std::atomic<uint32_t> ended{0};    ///< 1: no more force, whatever is requested
    std::atomic<uint32_t> closing{0};  ///< 1: pacing must end
    /// Also written by the device host when it ends; atomic, since its threads need no order here.
    std::atomic<Request> request{};
    /// Time of the newest request, monotonic(): the device host may have slept since.
    std::atomic<int64_t> asked_at{0};
    int64_t now = 0;  ///< time of a reading [ns]
    Wrench wrenches[kMostDevices];

    // written by the device host
    std::atomic<uint32_t> answered{0};  ///< number of requests answered
    std::atomic<uint32_t> offered{0};   ///< number of turns offered, while devices pace
    std::atomic<uint32_t> off{0};       ///< 1: since `ended` no force is on any device
    devices::Reading readings[kMostDevices];
};
static_assert(std::atomic<uint32_t>::is_always_lock_free);
static_assert(std::atomic<Request>::is_always_lock_free);
static_assert(std::atomic<int64_t>::is_always_lock_free);
static_assert(sizeof(std::atomic<uint32_t>) == sizeof(uint32_t));

/// Ends force: sets `ended`, and wakes the device host. Async-signal-safe.
void end_force(SharedPage& page) noexcept;
/// Sleeps while `word` is `old`, until woken or until `most` has passed. May wake without a cause,
/// so the caller must check the word again. Allocates nothing.
void wait_on(const std::atomic<uint32_t>& word, uint32_t old, Time most) noexcept;
/// Wakes all threads that wait on `word`, in both processes. Async-signal-safe.
void wake(std::atomic<uint32_t>& word) noexcept;
/// Adds one to `word`, and wakes all threads that wait on it.
void advance(std::atomic<uint32_t>& word) noexcept;
/// Waits until `word` differs from `old`; false if `most` has passed first. `hope`: time for
/// which it polls without sleeping, in case the change is imminent.
bool await_change(const std::atomic<uint32_t>& word, uint32_t old, Time most,
                  Time hope = Time(0)) noexcept;
/// Nanoseconds of CLOCK_MONOTONIC. Async-signal-safe.
int64_t monotonic() noexcept;

}  // namespace dihaptic::host
