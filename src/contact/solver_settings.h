// The names and settings of the contact solvers, for code that selects, records or compares solvers
// without using them.
#pragma once

#include <array>
#include <limits>

namespace dihaptic::contact {

enum class Solver { sequential_impulse, stewart_trinkle, staggered_projections, newton };
constexpr auto enum_names(Solver) {
    return std::array{"sequential_impulse", "stewart_trinkle", "staggered_projections", "newton"};
}
constexpr int kSolvers = 4;

/// Placement of the corners of a friction polygon: either fixed in the contact frame, or turned
/// with the sliding direction.
enum class DirectionFrame { fixed, sliding };
constexpr auto enum_names(DirectionFrame) {
    return std::array{"fixed", "sliding"};
}

/// Settings for stewart_trinkle.
struct PolygonSettings {
    int directions = 8;
    DirectionFrame frame = DirectionFrame::sliding;
};
constexpr int kMostDirections = 32;

/// Conditions under which sequential_impulse stops.
struct SweepSettings {
    int most = 200;
    double tolerance = 1e-7;  ///< largest change in a contact's velocity in the last sweep [m/s]
};

/// Work is counted in visits: a visit is the work that a sweep does on one contact.
constexpr int kUnbounded = std::numeric_limits<int>::max();

class Work;

struct SolveSettings {
    PolygonSettings polygon;
    SweepSettings sweeps;
    int work = kUnbounded;  ///< visits after which sweeps finish the solve (with at least
                            ///< kFewestSweeps sweeps); ignored by sequential_impulse
    Work* tick = nullptr;   ///< work budget shared by all solves of a tick; every solver obeys it
};

}  // namespace dihaptic::contact
