// Names the contact solvers and their settings, for code that selects, records or compares solvers
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

/// Placement of a friction polygon's corners: in directions fixed in the contact frame, or turned
/// with sliding.
enum class DirectionFrame { fixed, sliding };
constexpr auto enum_names(DirectionFrame) {
    return std::array{"fixed", "sliding"};
}

/// Settings of stewart_trinkle.
struct PolygonSettings {
    int directions = 8;
    DirectionFrame frame = DirectionFrame::sliding;
};
constexpr int kMostDirections = 32;

/// Conditions under which sequential_impulse ends.
struct SweepSettings {
    int most = 200;
    double tolerance = 1e-7;  ///< largest change of a contact's velocity in the last sweep [m/s]
};

/// Work is counted in visits: a visit is a sweep's work on one contact.
constexpr int kUnbounded = std::numeric_limits<int>::max();

class Work;

struct SolveSettings {
    PolygonSettings polygon;
    SweepSettings sweeps;
    int work = kUnbounded;  ///< visits after which sweeps end the solve (at least kFewestSweeps
                            ///< sweeps); not for sequential_impulse
    Work* tick = nullptr;   ///< for all solves of a tick together; every solver obeys it
};

}  // namespace dihaptic::contact
