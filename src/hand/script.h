// ScriptDriver moves the hand according to a script: aperture, centre and turn change step by step,
// along minimum-jerk trajectories.
//
//     p_WT = c + R (offset + a / 2 side),    R_WT = R
//
// Each finger has its own centre c, aperture a and turn R. A step changes these in the same way for
// all fingers that it moves: fingers with equal c, a and R form one hand, and a scene may contain
// several hands.
#pragma once

#include "hand/driver.h"
#include "hand/spec.h"

namespace dihaptic::hand {

class ScriptDriver final : public Driver {
  public:
    /// `fingers` are the names of the scene's fingers, in order. Throws Error if the script names
    /// any other finger.
    ScriptDriver(const HandSpec& spec, const std::vector<std::string>& fingers);

    double duration() const override { return phases_.empty() ? 0 : phases_.back().end; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    FingerTarget do_target(int finger, double t) const noexcept override;

    /// The motion of one finger's hand during a step.
    struct Motion {
        double aperture0 = 0, aperture1 = 0;                  // [m]
        Vec3 centre0 = Vec3::Zero(), centre1 = Vec3::Zero();  // [m]
        Vec3 v0 = Vec3::Zero(), v1 = Vec3::Zero();            // velocity of the centre [m/s]
        Quat R0 = Quat::Identity();                           // orientation at the step's start
        Vec3 axis = Vec3::UnitX();
        double angle = 0;  // angle of rotation in this step [rad]
    };
    struct Segment {
        double start = 0;
        double duration = 0;
        bool steady = false;
        std::vector<Motion> motions;  // one per finger
    };
    void add(const ScriptStep& step, const std::vector<std::string>& fingers);

    std::vector<Segment> segments_;
    std::vector<Phase> phases_;
    std::vector<FingerPlace> fingers_;
};

}  // namespace dihaptic::hand
