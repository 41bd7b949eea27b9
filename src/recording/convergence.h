// Describes how well the contact solver converged over a whole session.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "base/field.h"

namespace dihaptic::recording {

struct Convergence {
    int ticks = 0;        ///< number of ticks recorded
    int missed = 0;       ///< number of ticks in which the solver missed its tolerance
    int longest_run = 0;  ///< largest number of consecutive missed ticks
    /// Largest Frame::solver_held_residual, and the time of the tick in which it occurred [s];
    /// nullopt if it was not recorded.
    std::optional<double> held_residual, held_residual_time;

    template <class Visitor>
    void visit(Visitor& v) {
        v("ticks", ticks, Field::number().within(0, std::numeric_limits<int>::max()));
        v("missed", missed, Field::number().within(0, std::numeric_limits<int>::max()));
        v("longest_run", longest_run, Field::number().within(0, std::numeric_limits<int>::max()));
        v("held_residual", held_residual, Field::number().at_least(0));
        v("held_residual_time", held_residual_time, Field::of(Quantity::time));
    }

    /// Returns these figures as a sentence, even if the solver never missed its tolerance.
    std::string describe() const;
};

}  // namespace dihaptic::recording
