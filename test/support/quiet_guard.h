// Watches what a function does beside computing: locks that it takes, exceptions that it throws,
// and system calls that it makes.
#pragma once

#include <functional>
#include <map>
#include <string>

namespace dihaptic::testing {

/// Counts, in this thread while it is there: mutexes, read-write locks, semaphores and conditions
/// of the C library that are used, whether or not somebody else holds them; and exceptions thrown,
/// caught or not. Those functions are replaced in test programs.
class QuietGuard {
  public:
    QuietGuard();
    ~QuietGuard();
    QuietGuard(const QuietGuard&) = delete;
    QuietGuard& operator=(const QuietGuard&) = delete;

    size_t locks() const;
    size_t throws() const;
};

/// What a process of its own does while it runs `run`: system calls by number, none of which is
/// carried out. `ended` is empty when it came to its end.
struct SystemCalls {
    std::map<long, int> count;
    std::string ended;
};
SystemCalls system_calls(const std::function<void()>& run);

/// Whether both can be told in this build: sanitizers lock and call in the midst of everything, and
/// seccomp's frames are known for x86-64 Linux.
bool can_tell_quiet();

}  // namespace dihaptic::testing

/// First line of a test that needs them: skips it, aloud, where they cannot work.
#define DIHAPTIC_NEEDS_QUIET_GUARD()                                                            \
    if (!dihaptic::testing::can_tell_quiet())                                                   \
    GTEST_SKIP() << "locks and system calls cannot be counted here: sanitizers, or not x86-64 " \
                    "Linux"
