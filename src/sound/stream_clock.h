// Estimates when a sample of a stream is heard, from the times that the sound system states for
// each buffer, which jitter by more than a sample.
#pragma once

#include <cmath>
#include <cstdint>

namespace dihaptic::sound {

/// A delay-locked loop of first order: it follows the device's clock slowly, and jumps only when
/// the stream was interrupted, or when the stated time is far away.
class StreamClock {
  public:
    explicit StreamClock(double rate) : period_(1e9 / rate) {}

    /// When the next `samples` begin to be heard [ns]. `said`: the sound system's statement.
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

    /// The stream was interrupted: the next statement is taken as it is.
    void begin_anew() noexcept { begun_ = false; }

  private:
    static constexpr double kBroken = 30e6;   // [ns]
    static constexpr double kFollows = 0.02;  // of an error, in each buffer

    double period_;  // of samples [ns]
    double expected_ = 0;
    bool begun_ = false;
};

}  // namespace dihaptic::sound
