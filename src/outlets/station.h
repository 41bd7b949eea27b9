// Station passes event codes and samples from the servo to the outlets: the servo's thread pushes
// them into a ring and continues, and the station's own thread calls the outlets. A code is sent
// within a millisecond. Outlets that accept a time receive the time of the code's tick.
#pragma once

#include <atomic>
#include <semaphore>
#include <thread>

#include "base/ring.h"
#include "outlets/outlet.h"

namespace dihaptic::outlets {

class Station {
  public:
    /// Opens all outlets. Throws Error when an outlet cannot be opened.
    Station(const std::vector<OutletConfig>& outlets, const About& about);
    ~Station();
    Station(const Station&) = delete;
    Station& operator=(const Station&) = delete;

    /// Called in the tick: sends the tick's event code (0 if there is none) and one value for each
    /// channel. Neither waits nor allocates memory.
    void send(int code, std::span<const float> values) noexcept;
    /// Called in the tick: returns the trigger (1 to 255) received since the last call, or 0 if
    /// none was received.
    int take_trigger() noexcept { return trigger_.exchange(0, std::memory_order_relaxed); }
    /// Whether any outlet accepts samples. If not, the `values` passed to send() may be empty.
    bool wants_samples() const { return samples_; }

    /// Sends the remaining data and closes the outlets. Returns a message for each outlet that
    /// failed, and another if ticks were lost.
    std::vector<std::string> finish();

  private:
    struct Line {
        std::string kind;
        std::unique_ptr<Outlet> outlet;  // null once the outlet has failed
        bool samples;
    };
    void run();
    void drain();
    /// Calls a function of an outlet; once an outlet has thrown, it is not called again.
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
