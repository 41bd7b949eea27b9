// Latest hands the newest value from one thread that writes it to one that reads it. Neither thread
// waits, and neither sees half a value: there are three copies, and the two threads never hold the
// same copy.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace dihaptic {

template <class T>
class Latest {
  public:
    /// All three copies start as `value`.
    explicit Latest(const T& value = {}) : values_{value, value, value} {}

    /// All three copies, e.g. to reserve their memory. To be called only before the threads start.
    std::array<T, 3>& values() noexcept { return values_; }

    /// Writer: the copy to fill in, which still contains an old value. publish() hands it over.
    T& next() noexcept { return values_[writing_]; }
    void publish() noexcept {
        writing_ = shared_.exchange(static_cast<uint8_t>(writing_ | kNew), order()) & kIndex;
    }
    void publish(const T& value) noexcept {
        next() = value;
        publish();
    }

    /// Reader: the newest value that was published, valid until the next read().
    const T& read() noexcept {
        if (is_new()) reading_ = shared_.exchange(reading_, order()) & kIndex;
        return values_[reading_];
    }
    /// Reader: whether there is a newer value than read() last returned.
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
