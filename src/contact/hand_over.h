// The order in which solution methods are tried until one succeeds. README.md lists the work limits
// of the methods.
#pragma once

#include <array>

#include "contact/route.h"
#include "contact/solver_settings.h"

namespace dihaptic::contact {

struct HandOver {
    Solver asked;
    std::array<Route, 3> answer;  ///< `none` means that there is no further method
};
constexpr std::array<HandOver, kSolvers> kHandOver{{
    {Solver::sequential_impulse, {Route::sequential_impulse}},
    {Solver::stewart_trinkle, {Route::own_newton, Route::newton, Route::continuation}},
    {Solver::staggered_projections,
     {Route::staggered_projections, Route::newton, Route::continuation}},
    {Solver::newton, {Route::newton, Route::continuation}},
}};

/// Returns the methods to try if the requested solver is `asked`. If work is bounded, the first
/// method's answer is finished by sweeps; if work or memory does not suffice for an exact answer,
/// only sweeps are used.
constexpr std::array<Route, 3> hand_over(Solver asked, bool exact, bool bounded) {
    for (const HandOver& row : kHandOver) {
        if (row.asked != asked || !exact) continue;
        if (bounded)
            return {row.answer[0], Route::staggered_projections, Route::sequential_impulse};
        return row.answer;
    }
    return {Route::sequential_impulse};
}

}  // namespace dihaptic::contact
