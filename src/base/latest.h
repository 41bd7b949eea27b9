// Latest passes the newest value from one writing thread to one reading thread. Neither thread
// waits, and the reader never sees a partly written value: there are three copies, and the two
// threads never hold the same one.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace dihaptic {

template <class T>
class Latest {
  public:
    /// All three copies are initialised with `value`.
    explicit Latest(const T& value = {}) : values_{value, value, value} {}

    /// Returns all three copies, e.g. to reserve memory for them. Must be called only before the
    /// threads start.
    std::array<T, 3>& values() noexcept { return values_; }

    /// For the writer: the copy to fill in, which still contains an old value. publish() hands it
    /// over.
    T& next() noexcept { return values_[writing_]; }
    void publish() noexcept {
        writing_ = shared_.exchange(static_cast<uint8_t>(writing_ | kNew), order()) & kIndex;
    }
    void publish(const T& value) noexcept {
        next() = value;
        publish();
    }

    /// For the reader: the newest published value, valid until the next read().
    const T& read() noexcept {
        if (is_new()) reading_ = shared_.exchange(reading_, order()) & kIndex;
        return values_[reading_];
    }
    /// For the reader: whether a newer value than the one last returned by read() is available.
    bool is_new() const noexcept { return (shared_.load(std::memory_order_relaxed) & kNew) != 0; }

  private:
    static constexpr uint8_t kIndex = 3;
    static constexpr uint8_t kNew = 4;
    static constexpr std::memory_order order() { return std::memory_order_acq_rel; }

    std::array<T, 3> values_;
    std::atomic<uint8_t> shared_{1};
    alignas(64) uint8_t writing_ = 0;
    alignas(64) uint8_t reading_ = 2;
};

}  // namespace dihaptic
