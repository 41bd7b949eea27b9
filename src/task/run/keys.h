// Keys that were pressed and not read yet. A window that draws slowly passes on several keys at
// once, and none of them may be lost.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>

namespace dihaptic::task {

/// Neither allocates nor waits.
class Keys {
  public:
    static constexpr size_t kMost = 64;  ///< further keys replace the oldest ones

    /// From any thread.
    void add(char key) noexcept {
        if (key == 0) return;
        const size_t at = added_.fetch_add(1, std::memory_order_relaxed);
        keys_[at % kMost].store(key, std::memory_order_release);
    }
    /// The next key, in the order in which they were pressed; 0: none. From one thread.
    char take() noexcept {
        const char key = keys_[taken_ % kMost].exchange(0, std::memory_order_acquire);
        if (key != 0) ++taken_;
        return key;
    }

  private:
    std::array<std::atomic<char>, kMost> keys_{};
    std::atomic<size_t> added_{0};
    size_t taken_ = 0;
};

}  // namespace dihaptic::task
