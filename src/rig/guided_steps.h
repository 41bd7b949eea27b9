// Guides a person through steps while the devices exert no force.
#pragma once

#include <functional>
#include <string>

#include "rig/calibration_guide.h"
#include "rig/device_reader.h"

namespace dihaptic::rig {

class GuidedSteps {
  public:
    /// Time between two samples.
    static constexpr Time kEvery = std::chrono::milliseconds(20);

    GuidedSteps(DeviceReader& reader, const Guide& guide, int steps)
        : reader_(reader), guide_(guide) {
        now_.steps = steps;
    }

    void begin_step(const std::string& text) {
        ++now_.step;
        now_.text = text;
        tell(0, "");
    }
    void tell(double share, const std::string& measured) {
        now_.share = share;
        now_.measured = measured;
        guide_.show(now_);
    }
    /// Waits until the person reports that the step is done.
    void wait() {
        reader_.repeat([&] { return !guide_.done(); });
    }
    /// Calls `each` for every sample until it returns false. `said` says whether the person has
    /// reported since the last sample that the step is done.
    void sample(const std::function<bool(bool said)>& each);

  private:
    DeviceReader& reader_;
    const Guide& guide_;
    Guidance now_;
};

}  // namespace dihaptic::rig
