// ScriptDriver moves the hand by a script: aperture, centre and turn change step by step, by
// minimum jerk.
//
//     p_WT = c + R (offset + a / 2 side),    R_WT = R
//
// Each finger has a centre c, an aperture a and a turn R of its own. A step changes these in the
// same way for all fingers that it moves: fingers with equal c, a and R form one hand, and a scene
// may have several.
#pragma once

#include "hand/driver.h"
#include "hand/spec.h"

namespace dihaptic::hand {

class ScriptDriver final : public Driver {
  public:
    /// `fingers` are the names of the scene's fingers, in order. Throws Error if the script names
    /// others.
    ScriptDriver(const HandSpec& spec, const std::vector<std::string>& fingers);

    double duration() const override { return phases_.empty() ? 0 : phases_.back().end; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    FingerTarget do_target(int finger, double t) const noexcept override;

    /// The motion of one finger's hand in a step.
    struct Motion {
        double aperture0 = 0, aperture1 = 0;                  // [m]
        Vec3 centre0 = Vec3::Zero(), centre1 = Vec3::Zero();  // [m]
        Vec3 v0 = Vec3::Zero(), v1 = Vec3::Zero();            // of the centre [m/s]
        Quat R0 = Quat::Identity();                           // turn at the start of the step
        Vec3 axis = Vec3::UnitX();
        double angle = 0;  // turn in this step [rad]
    };
    struct Segment {
        double start = 0;
        double duration = 0;
        bool steady = false;
        std::vector<Motion> motions;  // by finger
    };
    void add(const ScriptStep& step, const std::vector<std::string>& fingers);

    std::vector<Segment> segments_;
    std::vector<Phase> phases_;
    std::vector<FingerPlace> fingers_;
};

}  // namespace dihaptic::hand
