// Makes a session on the virtual clock keep a pace for the viewer: in real time, slower, faster,
// tick by tick, or not at all while it is paused. The results are the same at any pace.
#pragma once

#include <chrono>

#include "session/listeners/live.h"

namespace dihaptic::session {

class Pacing {
  public:
    /// Both must outlive the object.
    Pacing(Live& live, const std::atomic<bool>& stop) : live_(live), stop_(stop) {}

    /// Call after the tick of session time `now`: waits until the next one is due.
    void wait(Time now);

  private:
    using Wall = std::chrono::steady_clock;
    bool over() const { return stop_ || live_.ended; }
    /// Waits for the end of a pause; returns whether one tick is to be performed in it.
    bool wait_in_pause();

    Live& live_;
    const std::atomic<bool>& stop_;
    double pace_ = -1;  // the pace kept since from_ and begun_
    Time from_{0};
    Wall::time_point begun_;
};

}  // namespace dihaptic::session
