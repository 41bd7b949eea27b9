// An adaptive procedure chooses the level of each trial by the answers so far. Every one of them
// can be used through Procedure, a value: a copy goes its own way, and the same answers always lead
// to the same state, so a session is resumed by giving them again.
#pragma once

#include <variant>

#include "experiment/procedures/quest.h"
#include "experiment/procedures/quest_plus.h"
#include "experiment/procedures/staircase.h"

namespace dihaptic::experiment {

class Procedure {
  public:
    using Kind = std::variant<Staircase, Quest, QuestPlus>;

    Procedure(Kind kind) : kind_(std::move(kind)) {}

    /// That the next trial should have.
    double level() const;
    /// A trial was at this level (as a rule the one proposed), and the answer was "yes", or
    /// correct: the one that grows likelier with the level. Throws Error when the level is not
    /// finite or the procedure is done.
    void answer(double level, bool yes);
    bool done() const;
    Estimate estimate() const;

    const Kind& kind() const { return kind_; }

  private:
    Kind kind_;
};

}  // namespace dihaptic::experiment
