// Hands what a tick has to say to the outlets, from a thread of its own: the servo's pushes into a
// ring and goes on. A code is on its way within a millisecond, and carries its tick's time to
// outlets that take one.
#pragma once

#include <atomic>
#include <semaphore>
#include <thread>

#include "base/ring.h"
#include "outlets/outlet.h"

namespace dihaptic::outlets {

class Station {
  public:
    /// Opens all outlets. Throws Error when one cannot be.
    Station(const std::vector<OutletConfig>& outlets, const About& about);
    ~Station();
    Station(const Station&) = delete;
    Station& operator=(const Station&) = delete;

    /// In the tick: its event code (0: none), and a value for each channel. Neither waits nor
    /// allocates.
    void send(int code, std::span<const float> values) noexcept;
    /// In the tick: the trigger that came in since the last call, 1 to 255; 0: none.
    int take_trigger() noexcept { return trigger_.exchange(0, std::memory_order_relaxed); }
    /// Whether any outlet wants samples: without, `values` may be empty.
    bool wants_samples() const { return samples_; }

    /// Sends what is left. Returns what went wrong, in words, for each outlet that gave up.
    std::vector<std::string> finish();

  private:
    struct Line {
        std::string kind;
        std::unique_ptr<Outlet> outlet;  // null once it gave up
        bool samples;
    };
    void run();
    void drain();
    /// Calls an outlet; one that throws is not called again.
    template <class Call>
    void call(Line& line, const Call& call);

    std::vector<Line> lines_;
    bool samples_ = false;
    size_t channels_;
    Ring ring_;
    std::vector<std::byte> sent_;      // servo's side
    std::vector<std::byte> received_;  // thread's side
    std::counting_semaphore<> marked_{0};
    std::atomic<int64_t> lost_{0};
    std::atomic<int> trigger_{0};
    std::atomic<bool> done_{false};
    std::vector<std::string> failures_;
    std::thread thread_;
};

}  // namespace dihaptic::outlets
