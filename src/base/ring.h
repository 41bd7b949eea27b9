// A ring of variable-size records between one producer thread and one consumer thread. Neither
// thread waits: if the ring is full, it refuses the record, and the producer counts the refused
// records.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace dihaptic {

class Ring {
  public:
    /// `capacity` [bytes] is rounded up to a power of two.
    explicit Ring(size_t capacity) {
        size_t size = 64;
        while (size < capacity) size *= 2;
        mask_ = size - 1;
        bytes_ = std::make_unique<std::byte[]>(size);
    }

    /// For the producer: appends a record; returns false if the record does not fit at present.
    /// Does not allocate or wait.
    bool push(std::span<const std::byte> record) noexcept {
        const uint64_t head = head_.load(std::memory_order_relaxed);
        const uint64_t tail = tail_.load(std::memory_order_acquire);
        const auto length = static_cast<uint32_t>(record.size());
        const uint64_t need = sizeof(length) + record.size();
        if (need > mask_ + 1 - (head - tail)) return false;
        write(head, std::as_bytes(std::span(&length, 1)));
        write(head + sizeof(length), record);
        head_.store(head + need, std::memory_order_release);
        return true;
    }

    /// For the consumer: copies the oldest record to `out` and resizes `out` to fit; returns false
    /// if the ring is empty.
    template <class Bytes>
    bool pop(Bytes& out) {
        const uint64_t tail = tail_.load(std::memory_order_relaxed);
        if (tail == head_.load(std::memory_order_acquire)) return false;
        uint32_t length = 0;
        read(tail, std::as_writable_bytes(std::span(&length, 1)));
        out.resize(length);
        read(tail + sizeof(length), std::as_writable_bytes(std::span(out)));
        tail_.store(tail + sizeof(length) + length, std::memory_order_release);
        return true;
    }

    size_t capacity() const noexcept { return mask_ + 1; }

  private:
    void write(uint64_t at, std::span<const std::byte> in) noexcept {
        const size_t start = at & mask_;
        const size_t first = std::min(in.size(), mask_ + 1 - start);
        std::memcpy(&bytes_[start], in.data(), first);
        std::memcpy(&bytes_[0], in.data() + first, in.size() - first);
    }
    void read(uint64_t at, std::span<std::byte> out) const noexcept {
        const size_t start = at & mask_;
        const size_t first = std::min(out.size(), mask_ + 1 - start);
        std::memcpy(out.data(), &bytes_[start], first);
        std::memcpy(out.data() + first, &bytes_[0], out.size() - first);
    }

    std::unique_ptr<std::byte[]> bytes_;
    uint64_t mask_ = 0;
    alignas(64) std::atomic<uint64_t> head_{0};
    alignas(64) std::atomic<uint64_t> tail_{0};
};

/// A ring of values of a single type.
template <class Value>
class ValueRing {
    static_assert(std::is_trivially_copyable_v<Value>);

  public:
    /// The ring has room for at least `count` values.
    explicit ValueRing(size_t count) : ring_(count * (sizeof(Value) + sizeof(uint32_t))) {
        taken_.reserve(sizeof(Value));
    }

    /// For the producer: appends a value; returns false if the ring is full. Does not allocate or
    /// wait.
    bool push(const Value& value) noexcept {
        return ring_.push(std::as_bytes(std::span(&value, 1)));
    }

    /// For the consumer: removes and returns the oldest value; nullopt if the ring is empty. Does
    /// not allocate or wait.
    std::optional<Value> pop() {
        if (!ring_.pop(taken_)) return std::nullopt;
        Value value;
        std::memcpy(&value, taken_.data(), sizeof value);
        return value;
    }

  private:
    Ring ring_;
    std::vector<std::byte> taken_;
};

}  // namespace dihaptic
