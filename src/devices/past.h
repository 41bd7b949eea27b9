// Past values of a sensor, from which a velocity is computed.
#pragma once

#include <algorithm>
#include <array>

#include "base/clock.h"

namespace dihaptic::devices {

/// The last values of one sensor, at most kMostWindow of them.
template <class T>
class Past {
  public:
    static constexpr int kMostWindow = 64;

    explicit Past(int window) : window_(window) {}

    struct Sample {
        Time time{0};
        T value;
    };
    /// Stores a value, and returns the value stored `window` calls earlier or, if there have been
    /// fewer calls, the oldest value. At the first call, returns null.
    const Sample* exchange(Time now, const T& value) noexcept {
        const auto size = static_cast<int>(past_.size());
        past_[static_cast<size_t>(count_ % size)] = {now, value};
        const int back = std::min(window_, count_);
        const Sample& old = past_[static_cast<size_t>((count_ - back) % size)];
        ++count_;
        return back == 0 ? nullptr : &old;
    }

  private:
    int window_;
    std::array<Sample, kMostWindow + 1> past_{};
    int count_ = 0;
};

}  // namespace dihaptic::devices
