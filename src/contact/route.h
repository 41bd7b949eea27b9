// Route identifies the method that found the impulses in use. README.md gives the order in which
// the methods are tried.
#pragma once

#include <array>

namespace dihaptic::contact {

/// Recorded with every tick, so append new values at the end.
enum class Route {
    none,            ///< no problem, a refused problem, or an older recording
    start,           ///< the initial impulses already solved the problem
    newton,          ///< Newton's method on the Coulomb cone
    own_newton,      ///< stewart_trinkle: Newton's method on the friction polygon
    lemke,           ///< stewart_trinkle: Lemke's method on the friction polygon
    coarse_polygon,  ///< newton, from the answer for a coarse polygon; in older recordings only
    staggered_projections,
    sweeps,  ///< newton, from the result of many sweeps; in older recordings only
    sequential_impulse,
    out_of_work,  ///< sweeps, after the tick's work budget was used up
    continuation  ///< newton, followed from the answer of a problem with other friction
};
constexpr auto enum_names(Route) {
    return std::array{"none",
                      "start",
                      "newton",
                      "own_newton",
                      "lemke",
                      "coarse_polygon",
                      "staggered_projections",
                      "sweeps",
                      "sequential_impulse",
                      "out_of_work",
                      "continuation"};
}

}  // namespace dihaptic::contact
