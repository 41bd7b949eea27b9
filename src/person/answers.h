// The answers of a simulated person: keys that say whether the last movement looked larger than it
// felt, and ratings, which are typed.
#pragma once

#include <array>

#include "base/random.h"
#include "person/traits.h"
#include "task/plan/task_plan.h"

namespace dihaptic::person {

/// Where a person sees and feels the own hand [m].
struct SeenAndFelt {
    Vec3 shown = Vec3::Zero();
    Vec3 felt = Vec3::Zero();
};

class Answers {
  public:
    void restart() noexcept;

    /// To be called when a movement begins about whose extent questions may be asked.
    void begin_movement(const SeenAndFelt& hand) noexcept { from_ = hand; }
    /// To be called when a state begins. If the state asks, the person decides at `decides` [s].
    void enter(const task::TaskPlan::PlannedState& state, double decides) noexcept;
    bool is_due(double now) const noexcept { return at_ >= 0 && now >= at_; }
    /// Answers the question that is due.
    void answer(const Traits& traits, const task::TaskPlan::PlannedState& state,
                const SeenAndFelt& hand, double now, Random& random) noexcept;
    /// Returns the next key that is pressed, or 0 if there is none.
    char take_key() noexcept;

  private:
    void rate(const task::TaskPlan::Questions& questions, double now, Random& random) noexcept;

    SeenAndFelt from_;  // where the last sufficiently long movement began
    double at_ = -1;    // time of the answer [s]; negative if there is no question
    size_t rated_ = 0;  // number of questions of the state that have been answered
    char key_ = 0;
    std::array<char, 12> typed_{};  // digits of the answer being typed
    size_t typed_length_ = 0;
    size_t typed_at_ = 0;
};

}  // namespace dihaptic::person
