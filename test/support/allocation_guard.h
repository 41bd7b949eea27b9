// Counts every memory allocation of this thread while it is armed, libraries' included: malloc and
// its kin are replaced in test programs.
#pragma once

#include <cstddef>

namespace dihaptic::testing {

class AllocationGuard {
  public:
    AllocationGuard();
    ~AllocationGuard();
    AllocationGuard(const AllocationGuard&) = delete;
    AllocationGuard& operator=(const AllocationGuard&) = delete;

    /// Allocations and releases since this guard was made.
    size_t count() const;

    /// Whether allocations can be counted in this build: sanitizers use their own malloc.
    static bool works();
};

}  // namespace dihaptic::testing

/// First line of a test that needs the guard: skips the test, with a message, where it cannot work.
#define DIHAPTIC_NEEDS_ALLOCATION_GUARD()             \
    if (!dihaptic::testing::AllocationGuard::works()) \
    GTEST_SKIP() << "sanitizers replace malloc: allocations cannot be counted"
