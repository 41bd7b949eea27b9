// Runs a session on the virtual clock at the pace that the viewer chooses: in real time, slower,
// faster, tick by tick, or not at all while the session is paused. The results are the same at any
// pace.
#pragma once

#include <chrono>

#include "session/listeners/live.h"

namespace dihaptic::session {

class Pacing {
  public:
    /// Both arguments must outlive this object.
    Pacing(Live& live, const std::atomic<bool>& stop) : live_(live), stop_(stop) {}

    /// Must be called after the tick of session time `now`; waits until the next tick is due.
    void wait(Time now);

  private:
    using Wall = std::chrono::steady_clock;
    bool over() const { return stop_ || live_.ended; }
    /// Waits for the end of a pause. Returns whether one tick is to run during the pause.
    bool wait_in_pause();

    Live& live_;
    const std::atomic<bool>& stop_;
    double pace_ = -1;  // pace used since the times from_ and begun_
    Time from_{0};
    Wall::time_point begun_;
};

}  // namespace dihaptic::session
