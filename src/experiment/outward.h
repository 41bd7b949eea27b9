// What a session sends while it runs to what else a lab records with: event codes, handle positions
// and forces; and the triggers that come back.
#pragma once

#include <string>
#include <vector>

#include "experiment/plan.h"
#include "outlets/station.h"

namespace dihaptic::experiment {

class Outward {
  public:
    /// `session`: its folder's name. Throws Error when an outlet cannot be opened.
    Outward(const Plan& plan, const std::string& session);

    /// In the tick.
    void send(const servo::Frame& frame) noexcept;
    /// In the tick: a code that came in since the last call; 0: none.
    int take_trigger() noexcept { return station_.take_trigger(); }
    /// After the last tick: what went wrong on the way.
    std::vector<std::string> finish() { return station_.finish(); }

  private:
    outlets::Station station_;
    std::vector<float> values_;  // of all channels, in their order
};

}  // namespace dihaptic::experiment
