// A descriptor owns an open file, socket or the like, and closes it on destruction.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace dihaptic {

class Descriptor {
  public:
    Descriptor() = default;
    /// `number` is the value returned by open(), socket() and the like; if it is negative, nothing
    /// is open.
    explicit Descriptor(int number) noexcept : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        const int number = std::exchange(other.number_, -1);
        close();
        number_ = number;
        return *this;
    }

    explicit operator bool() const noexcept { return number_ >= 0; }
    /// The number; negative if nothing is open.
    int get() const noexcept { return number_; }
    /// Closes the file and leaves errno unchanged, because a failure is often reported after its
    /// file has been closed.
    void close() noexcept {
        if (number_ < 0) return;
        const int why = errno;
        ::close(std::exchange(number_, -1));
        errno = why;
    }

  private:
    int number_ = -1;
};

}  // namespace dihaptic
