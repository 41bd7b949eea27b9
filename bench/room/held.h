// Measures how calmly two fingers hold objects with joints, compared with the rigid block of `bench
// grasp`, and how much time they add to a tick.
#pragma once

#include <array>

#include "measure/grasp.h"

namespace dihaptic::bench {

/// The part on the block; together they weigh as much as the rigid block.
enum class Held {
    nothing,
    hinge,       ///< a second block that turns about an upright axis
    slider,      ///< one that slides away from the grasp
    spring,      ///< one on a spring of 200 N/m that swings up and down
    six_hinges,  ///< a tower of six that turn on each other
};

/// The highest stiffness of the list of `bench grasp` up to which it is held calmly [N/m].
double calm_k(Held held, contact::Solver solver);

/// Time of a tick while it is held: the 99th percentile [us].
double tick_p99(Held held, contact::Solver solver);

}  // namespace dihaptic::bench
