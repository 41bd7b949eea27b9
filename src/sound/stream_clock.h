// Estimates when a sample of a stream is heard, using the times that the sound system reports for
// each buffer. These times jitter by more than a sample.
#pragma once

#include <cmath>
#include <cstdint>

namespace dihaptic::sound {

/// A first-order delay-locked loop. It follows the device's clock slowly, and jumps only when the
/// stream was interrupted or when the reported time is far off.
class StreamClock {
  public:
    explicit StreamClock(double rate) : period_(1e9 / rate) {}

    /// Returns the time at which the next `samples` begin to be heard [ns]. `said`: the time that
    /// the sound system reported [ns].
    int64_t next(int64_t said, size_t samples) noexcept {
        const double error = static_cast<double>(said) - expected_;
        if (!begun_ || std::abs(error) > kBroken) {
            expected_ = static_cast<double>(said);
            begun_ = true;
        } else {
            expected_ += kFollows * error;
        }
        const auto out = static_cast<int64_t>(std::llround(expected_));
        expected_ += static_cast<double>(samples) * period_;
        return out;
    }

    /// Notes that the stream was interrupted, so that the next reported time is used unchanged.
    void begin_anew() noexcept { begun_ = false; }

  private:
    static constexpr double kBroken = 30e6;   // [ns]
    static constexpr double kFollows = 0.02;  // fraction of the error corrected in each buffer

    double period_;  // sampling period [ns]
    double expected_ = 0;
    bool begun_ = false;
};

}  // namespace dihaptic::sound
