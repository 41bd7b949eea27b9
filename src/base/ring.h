// A ring of variable-size records between one producer thread and one consumer thread. Neither side
// waits: a full ring refuses the record, and the producer counts what it could not hand over.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

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

    /// Producer: appends a record; false when it does not fit now. Does not allocate or wait.
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

    /// Consumer: copies the oldest record to `out`, resizing it; false when the ring is empty.
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

}  // namespace dihaptic
