// The station passes event codes and samples from the servo to the outlets: the servo's thread
// pushes them into a ring and continues; the station's own thread calls the outlets. A code is sent
// within a millisecond, and outlets that accept a time get that of its tick.
#pragma once

#include <atomic>
#include <semaphore>
#include <thread>

#include "base/ring.h"
#include "outlets/outlet.h"

namespace dihaptic::outlets {

class Station {
  public:
    /// Opens all outlets. Throws Error when one cannot be opened.
    Station(const std::vector<OutletConfig>& outlets, const About& about);
    ~Station();
    Station(const Station&) = delete;
    Station& operator=(const Station&) = delete;

    /// Called in the tick: sends its event code (0: none) and a value for each channel. Neither
    /// waits nor allocates.
    void send(int code, std::span<const float> values) noexcept;
    /// Called in the tick: the trigger received since the last call, 1 to 255; 0: none.
    int take_trigger() noexcept { return trigger_.exchange(0, std::memory_order_relaxed); }
    /// Whether any outlet accepts samples; if not, `values` may be empty.
    bool wants_samples() const { return samples_; }

    /// Sends remaining data, and closes the outlets. Returns the failures, in words: an entry for
    /// each outlet that failed, and one if ticks were lost.
    std::vector<std::string> finish();

  private:
    struct Line {
        std::string kind;
        std::unique_ptr<Outlet> outlet;  // null after a failure
        bool samples;
    };
    void run();
    void drain();
    /// Calls an outlet; an outlet that throws is not called again.
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
