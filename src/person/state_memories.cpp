#include "person/state_memories.h"

#include <algorithm>

namespace dihaptic::person {
namespace {

using task::TaskPlan;

StateMemory unlearned(const Traits& traits) {
    return {RotationMemory(traits.rotation(), traits.generalisation,
                           {traits.fast_limit, traits.slow_limit}),
            GainMemory(traits.gain()), ForceMemory(traits.force(), traits.force_generalisation)};
}

/// The region to which the last reaching step of a state leads; -1 if there is none.
int reached_by(const std::vector<TaskPlan::Step>& steps) noexcept {
    int out = -1;
    for (const TaskPlan::Step& step : steps) {
        if (step.step.reach.index >= 0) out = step.step.reach.index;
    }
    return out;
}

/// For each state, the first state whose reaches lead to the same region.
std::vector<size_t> first_of_same_region(const std::vector<std::vector<TaskPlan::Step>>& steps) {
    std::vector<size_t> out;
    for (size_t i = 0; i < steps.size(); ++i) {
        const int region = reached_by(steps[i]);
        size_t first = i;
        for (size_t j = i; region >= 0 && j-- > 0;) {
            if (reached_by(steps[j]) == region) first = j;
        }
        out.push_back(first);
    }
    return out;
}

}  // namespace

StateMemories::StateMemories(const Traits& traits, const TaskPlan& plan,
                             const std::vector<std::vector<TaskPlan::Step>>& steps)
    : unlearned_(unlearned(traits)),
      first_(first_of_same_region(steps)),
      memories_(plan.states.size(), unlearned_),
      appears_(plan.states.size(), 0) {
    for (const task::State& state : plan.task.states) names_.push_back(state.name);
}

void StateMemories::restart(const std::vector<Learned::InState>& before) noexcept {
    std::fill(appears_.begin(), appears_.end(), 0);
    std::fill(memories_.begin(), memories_.end(), unlearned_);
    for (const Learned::InState& known : before) {
        for (size_t i = 0; i < names_.size(); ++i) {
            if (names_[i] == known.state) of(i) = known.memory;
        }
    }
}

std::vector<Learned::InState> StateMemories::overnight() const {
    std::vector<Learned::InState> out;
    for (size_t i = 0; i < names_.size(); ++i) {
        out.push_back({names_[i], of(i)});
        out.back().memory.rotation.sleep();
        out.back().memory.force.sleep();
    }
    return out;
}

}  // namespace dihaptic::person
