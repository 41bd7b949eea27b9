// The simulated hands that an experiment file describes for its task. On entry into a state, they
// start the steps of that state from their current position, with minimum-jerk motion as in a
// script.
#pragma once

#include <memory>

#include "task/run/seeing_driver.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::task {

class TaskHand final : public SeeingDriver {
  public:
    /// Throws Error if the fingers in the spec are not the same as `fingers`.
    TaskHand(std::shared_ptr<const TaskPlan> plan, const hand::HandSpec& spec,
             const std::vector<std::string>& fingers);

    double duration() const override { return hand::kLongestScript; }
    const std::vector<Phase>& phases() const override { return phases_; }
    void restart() override;

  private:
    hand::FingerTarget do_target(int finger, double t) const noexcept override;
    void do_see(const frame::Frame& frame) noexcept override;
    void begin_step(double now) noexcept;

    /// The hand posture of a finger during its step.
    struct Posture {
        Vec3 centre = Vec3::Zero();
        double aperture = 0;
    };
    Posture posture(size_t finger, double t) const noexcept;

    std::shared_ptr<const TaskPlan> plan_;
    TrialNumbers numbers_;
    std::vector<hand::FingerPlace> places_;
    // start of each finger's step; the following members are also by finger
    std::vector<Posture> start_;
    std::vector<Phase> phases_;
    int trial_ = 0;
    int attempt_ = 0;
    int phase_ = -1;
    size_t step_ = 0;      // index of the state's current step
    double begun_ = 0;     // [s]
    double duration_ = 1;  // [s]
    std::vector<Posture> from_;
    std::vector<Posture> to_;
};

}  // namespace dihaptic::task
