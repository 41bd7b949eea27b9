// Watches what a function does besides computing: locks that it takes, exceptions that it throws,
// and system calls that it makes.
#pragma once

#include <functional>
#include <map>
#include <string>

namespace dihaptic::testing {

/// Counts, in this thread during its lifetime: mutexes, read-write locks, semaphores and conditions
/// of the C library that are used, whether or not somebody else holds them; and exceptions thrown,
/// caught or not. The library's functions for these are replaced in test programs.
class QuietGuard {
  public:
    QuietGuard();
    ~QuietGuard();
    QuietGuard(const QuietGuard&) = delete;
    QuietGuard& operator=(const QuietGuard&) = delete;

    size_t locks() const;
    size_t throws() const;
};

/// What a separate process does while it runs `run`: system calls by number, none of which is
/// carried out. `ended` is empty if `run` came to its end.
struct SystemCalls {
    std::map<long, int> count;
    std::string ended;
};
SystemCalls system_calls(const std::function<void()>& run);

/// Whether both can be counted in this build: sanitizers take locks and make system calls at any
/// time, and seccomp's frames are known only for x86-64 Linux.
bool can_tell_quiet();

}  // namespace dihaptic::testing

/// First line of a test that needs these counts: skips the test, with a message, without them.
#define DIHAPTIC_NEEDS_QUIET_GUARD()                                                            \
    if (!dihaptic::testing::can_tell_quiet())                                                   \
    GTEST_SKIP() << "locks and system calls cannot be counted here: sanitizers, or not x86-64 " \
                    "Linux"
