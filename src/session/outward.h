// Sends event codes, handle positions and forces of a running session to a lab's other recording
// systems, and receives their triggers.
#pragma once

#include <string>
#include <vector>

#include "outlets/station.h"
#include "session/plan.h"

namespace dihaptic::session {

class Outward {
  public:
    /// `session`: name of the session's folder. Throws Error when an outlet cannot be opened.
    Outward(const Plan& plan, const std::string& session);

    /// Call in the tick.
    void send(const frame::Frame& frame) noexcept;
    /// Call in the tick: a code received since the last call; 0 if none.
    int take_trigger() noexcept { return station_.take_trigger(); }
    /// Call after the last tick: returns any faults.
    std::vector<std::string> finish() { return station_.finish(); }

  private:
    outlets::Station station_;
    std::vector<float> values_;  // one per channel
};

}  // namespace dihaptic::session
