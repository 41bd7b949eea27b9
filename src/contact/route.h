// Route names the method that found the impulses in use. README.md gives the order in which methods
// are tried.
#pragma once

#include <array>

namespace dihaptic::contact {

/// Recorded with every tick, so append new values at the end.
enum class Route {
    none,            ///< no problem, a refused problem, or an older recording
    start,           ///< the start already solved the problem
    newton,          ///< Newton's method on Coulomb's cone
    own_newton,      ///< stewart_trinkle: Newton's method on its friction polygon
    lemke,           ///< stewart_trinkle: Lemke's method on its friction polygon
    coarse_polygon,  ///< newton, started from an answer on a polygon of four directions
    staggered_projections,
    sweeps,  ///< newton, started after many projected Gauss-Seidel sweeps
    sequential_impulse,
    out_of_work  ///< sweeps, after the tick's counted work was used up
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
                      "out_of_work"};
}

}  // namespace dihaptic::contact
