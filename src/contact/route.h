// What found the impulses that are in use; README.md has who is asked after whom.
#pragma once

#include <array>

namespace dihaptic::contact {

/// Recorded with every tick: new ones go to the end.
enum class Route {
    none,            ///< there was nothing to solve, or it was refused; or an older recording
    start,           ///< what was given was an answer already
    newton,          ///< Newton's method on Coulomb's cone
    own_newton,      ///< stewart_trinkle: the same on its friction polygon
    lemke,           ///< stewart_trinkle: Lemke's method on its friction polygon
    coarse_polygon,  ///< newton, begun at an answer on a polygon of four directions
    staggered_projections,
    sweeps,  ///< newton, begun after many projected Gauss-Seidel sweeps
    sequential_impulse
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
                      "sequential_impulse"};
}

}  // namespace dihaptic::contact
