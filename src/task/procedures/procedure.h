// A procedure chooses the level of each trial, usually from the answers so far. Procedure wraps any
// of the procedures as a value: copies are independent, and the same answers always lead to the
// same state, so a session is resumed by replaying its answers.
#pragma once

#include <variant>

#include "task/procedures/constant.h"
#include "task/procedures/quest.h"
#include "task/procedures/quest_plus.h"
#include "task/procedures/staircase.h"

namespace dihaptic::task {

class Procedure {
  public:
    using Kind = std::variant<Staircase, Quest, QuestPlus, Constant>;

    Procedure(Kind kind) : kind_(std::move(kind)) {}

    /// Returns the level proposed for the next trial.
    double level() const;
    /// Processes the answer in a trial at this level, which is usually the proposed one. `yes`
    /// means that the answer was "yes" or correct, i.e. the one whose probability increases with
    /// the level. Throws Error if the level is not finite or the procedure is done.
    void answer(double level, bool yes);
    bool done() const;
    Estimate estimate() const;

    const Kind& kind() const { return kind_; }

  private:
    Kind kind_;
};

}  // namespace dihaptic::task
