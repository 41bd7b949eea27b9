// What a simulated person learns from the movements in each state of the task. States whose reaches
// lead to the same region share a memory: what is learned in one of them shows in the others, e.g.
// in reaches without a cursor, but the movement back does not undo what the movement there has
// taught.
#pragma once

#include <vector>

#include "person/learned.h"
#include "person/traits.h"
#include "task/plan/task_plan.h"

namespace dihaptic::person {

class StateMemories {
  public:
    /// `steps`: those of the person's hand, by state of the task.
    StateMemories(const Traits& traits, const task::TaskPlan& plan,
                  const std::vector<std::vector<task::TaskPlan::Step>>& steps);

    /// Forgets everything except what `before` holds for states of the same names.
    void restart(const std::vector<Learned::InState>& before) noexcept;
    /// What the person will retain overnight, for each state.
    std::vector<Learned::InState> overnight() const;

    StateMemory& of(size_t state) noexcept { return memories_[first_[state]]; }
    const StateMemory& of(size_t state) const noexcept { return memories_[first_[state]]; }

    /// Whether a cursor that was hidden at first appeared later in the last reach of this state.
    bool cursor_appears(size_t state) const noexcept { return appears_[state] != 0; }
    void note_cursor(size_t state, bool appeared) noexcept { appears_[state] = appeared; }

  private:
    StateMemory unlearned_;
    std::vector<std::string> names_;     // of the states
    std::vector<size_t> first_;          // by state: the first state that uses the same memory
    std::vector<StateMemory> memories_;  // by the first state that uses it
    std::vector<char> appears_;          // by state
};

}  // namespace dihaptic::person
