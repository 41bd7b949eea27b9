// Mixes sounds into a stream of samples. Each sound begins at a fixed time after its request, with
// an accuracy of one sample.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "base/ring.h"
#include "sound/wave.h"

namespace dihaptic::sound {

/// A request to start or to end a sound.
struct Order {
    int64_t tick = 0;
    int32_t sound = -1;
    bool begins = true;
    double asked = 0;  ///< session time of the request [s]
    int64_t at = 0;    ///< time `asked` on the clock of the stream [ns]
};

/// The onset of a sound, i.e. when it was heard.
struct Onset {
    int64_t tick = 0;
    int32_t sound = -1;
    double asked = 0;  ///< session time of the request [s]
    double heard = 0;  ///< session time at which the sound was heard [s]
};

class Mixer {
  public:
    /// `delay`: time from a request to its sound [s].
    Mixer(std::vector<Wave> waves, double rate, double delay);

    /// Must be called from one thread: adds a request, without waiting or allocating. Returns false
    /// when too many requests are pending.
    bool order(const Order& order) noexcept { return orders_.push(order); }
    /// Must be called from a second thread: renders the next samples of the stream, without waiting
    /// or allocating. `first`: time at which the first of these samples is heard, on the stream's
    /// clock [ns].
    void render(std::span<float> out, int64_t first) noexcept;
    /// Must be called from a third thread: removes and returns the oldest onset not yet taken.
    std::optional<Onset> take_onset() { return onsets_.pop(); }

    double rate() const noexcept { return rate_; }
    /// Number of sounds that were dropped because too many were playing at once.
    int64_t left_out() const noexcept { return left_out_.load(std::memory_order_relaxed); }

  private:
    struct Voice {
        int32_t sound = -1;  // -1: free
        int64_t wait = 0;    // number of samples until the sound begins
        size_t at = 0;       // index of the next sample of the wave
        int64_t age = 0;     // number of samples since the sound began
        int64_t ends = -1;   // number of samples until the sound begins to fade; -1 if not known
        int64_t faded = 0;   // number of samples since the sound began to fade
    };
    int64_t samples_until(int64_t at, int64_t first) const noexcept;
    void take(const Order& order, int64_t first) noexcept;
    void begin(const Order& order, int64_t first) noexcept;
    void mix(Voice& voice, std::span<float> out) noexcept;

    static constexpr size_t kMostVoices = 32;
    static constexpr size_t kMostOrders = 1024;

    std::vector<Wave> waves_;
    double rate_;
    int64_t delay_;  // [ns]
    std::array<Voice, kMostVoices> voices_;
    ValueRing<Order> orders_{kMostOrders};
    ValueRing<Onset> onsets_{kMostOrders};
    std::atomic<int64_t> left_out_{0};
};

}  // namespace dihaptic::sound
