// The simulated hands that an experiment file describes for its task: on entering a state they
// begin that state's steps from where they are, by minimum jerk as in a script.
#pragma once

#include <memory>

#include "task/run/seeing_driver.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::task {

class TaskHand final : public SeeingDriver {
  public:
    /// Throws Error when the spec names other fingers than `fingers`.
    TaskHand(std::shared_ptr<const TaskPlan> plan, const hand::HandSpec& spec,
             const std::vector<std::string>& fingers);

    double duration() const override { return hand::kLongestScript; }
    const std::vector<Phase>& phases() const override { return phases_; }
    void restart() override;

  private:
    hand::FingerTarget do_target(int finger, double t) const noexcept override;
    void do_see(const frame::Frame& frame) noexcept override;
    void begin_step(double now) noexcept;

    /// Where a finger's hand is in its step.
    struct Posture {
        Vec3 centre = Vec3::Zero();
        double aperture = 0;
    };
    Posture posture(size_t finger, double t) const noexcept;

    std::shared_ptr<const TaskPlan> plan_;
    TrialNumbers numbers_;
    std::vector<hand::FingerPlace> places_;
    std::vector<Posture> start_;  // by finger, as those below
    std::vector<Phase> phases_;
    int trial_ = 0;
    int attempt_ = 0;
    int phase_ = -1;
    size_t step_ = 0;      // index among the state's steps
    double begun_ = 0;     // [s]
    double duration_ = 1;  // [s]
    std::vector<Posture> from_;
    std::vector<Posture> to_;
};

}  // namespace dihaptic::task
