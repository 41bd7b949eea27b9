// Finds episodes in which the object is held, slides on something or flies, using only the frames,
// and computes those figures for which mechanics gives a closed form.
//
// hold    fingers press the object and nothing else does. Figures: how far they slipped, how far
//         it sank, and how far it turned with the line between the first two fingers.
// slide the object moves along its support. With F the fingers' forces on it, n the support's
//         normal, N = -(F + m g) . n, and v the velocity at the contact, work balances:
//
//             sum h (F + m g) . v + m (v_start^2 - v_end^2) / 2 = mu sum h N |v|
//
//         `friction_ratio` is the left side over the right: 1 while the object does not turn. A
//         block let go at v stops within v^2 / (2 mu g); one that is pushed steadily takes mu m g.
// flight  nothing touches the object. Figures: the ratio of its velocity at release to the hand's
//         (the mean velocity of the handles that release it, along its own), and its largest
//         distance from the parabola of its first step.
#pragma once

#include <vector>

#include "analysis/grasp_trace.h"
#include "base/unmeasured.h"
#include "rows/episode_row.h"

namespace dihaptic::analysis {

/// An episode and its position in the trace.
struct Episode : rows::EpisodeRow {
    Range range;                  ///< range of samples in the trace
    std::vector<size_t> fingers;  ///< fingers that press the object or, in a flight, released it
};

/// Properties of the object that its mechanics depend on; NaN if unknown.
struct ObjectFacts {
    double mass = kUnmeasured;  ///< [kg]
    Vec3 gravity = Vec3::Constant(kUnmeasured);
    std::vector<double> friction;         ///< coefficients with each body of the scene
    std::vector<double> finger_friction;  ///< coefficients with each finger
    bool flies = true;  ///< whether the object falls when untouched, i.e. no joint or rail holds it
};

/// Returns the episodes in time order. A state that lasts less than 20 ms is not an episode.
std::vector<Episode> find_episodes(const GraspTrace& trace, const ObjectFacts& object);

}  // namespace dihaptic::analysis
