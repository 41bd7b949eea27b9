// Which solver answers contact problems, and what can be chosen about it: all that settings, codes
// and benches say of solvers, without the solvers themselves.
#pragma once

#include <array>

namespace dihaptic::contact {

enum class Solver { sequential_impulse, stewart_trinkle, staggered_projections, newton };
constexpr auto enum_names(Solver) {
    return std::array{"sequential_impulse", "stewart_trinkle", "staggered_projections", "newton"};
}
constexpr int kSolvers = 4;

/// How a friction polygon's corners lie: in directions fixed to the contact, or turned with
/// sliding.
enum class DirectionFrame { fixed, sliding };
constexpr auto enum_names(DirectionFrame) {
    return std::array{"fixed", "sliding"};
}

/// Of stewart_trinkle.
struct PolygonSettings {
    int directions = 8;
    DirectionFrame frame = DirectionFrame::sliding;
};
constexpr int kMostDirections = 32;

}  // namespace dihaptic::contact
