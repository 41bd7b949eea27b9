// Measures the calmness with which two fingers hold objects with joints, compared with the rigid
// block of `bench grasp`, and the time that the joints add to a tick.
#pragma once

#include <array>

#include "measure/grasp.h"

namespace dihaptic::bench {

/// The part on the block; together they weigh as much as the rigid block.
enum class Held {
    nothing,
    hinge,       ///< a second block that turns about an upright axis
    slider,      ///< a block that slides away from the grasp
    spring,      ///< a block that swings up and down on a spring of 200 N/m
    six_hinges,  ///< a tower of six blocks on hinges
};

/// The highest stiffness in the list of `bench grasp` at which the object is held calmly [N/m].
double calm_k(Held held, contact::Solver solver);

/// 99th percentile of a tick's time while the object is held [us].
double tick_p99(Held held, contact::Solver solver);

}  // namespace dihaptic::bench
