// A hand that follows a script: aperture and centre change step by step, by minimum jerk.
#pragma once

#include "hand/driver.h"
#include "hand/spec.h"

namespace dihaptic::hand {

class ScriptDriver final : public Driver {
  public:
    /// `fingers` names the fingers that there are, in order. Throws Error when the script names
    /// others.
    ScriptDriver(const HandSpec& spec, const std::vector<std::string>& fingers);

    double duration() const override { return phases_.empty() ? 0 : phases_.back().end; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    FingerTarget do_target(int finger, double t) const noexcept override;

    struct Segment {
        double start = 0;
        double duration = 0;
        double aperture0 = 0, aperture1 = 0;
        Vec3 centre0, centre1;
        bool steady = false;
    };
    std::vector<Segment> segments_;
    std::vector<Phase> phases_;
    std::vector<FingerPlace> fingers_;
};

}  // namespace dihaptic::hand
