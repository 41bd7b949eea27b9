// Finds episodes in which the object is held, slides on something, or flies, from the frames alone,
// and computes the figures for which mechanics has a closed form.
//
// hold    fingers press the object and nothing else does. Figures: how far they slipped, how far
//         it sank, and how far it turned with the line between the first two fingers.
// slide   the object moves along what it lies on. With F the fingers' forces on it, n the support's
//         normal, N = -(F + m g) . n, and v the velocity at the contact, work balances:
//
//             sum h (F + m g) . v + m (v_start^2 - v_end^2) / 2 = mu sum h N |v|
//
//         `friction_ratio` is the left side over the right: 1 while the object does not turn. A
//         block let go at v stops within v^2 / (2 mu g); one that is pushed steadily takes mu m g.
// flight  nothing touches the object. Figures: its velocity when let go over the hand's (the mean
//         of the handles that let go, along it), and its largest distance from the parabola of its
//         first step.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "analysis/grasp_trace.h"

namespace dihaptic::analysis {

enum class EpisodeKind { hold, slide, flight };
constexpr auto enum_names(EpisodeKind) {
    return std::array{"hold", "slide", "flight"};
}

/// One episode. Figures that its kind does not have are NaN.
struct Episode {
    EpisodeKind kind = EpisodeKind::hold;
    Range range;                  ///< samples of the trace
    double start = 0;             ///< [s]
    double end = 0;               ///< [s]
    std::vector<size_t> fingers;  ///< fingers that press the object; flight: that let it go
    double slip = kNone;          ///< hold: largest slip of these fingers on the object [m]
    double least_slip = kNone;  ///< hold: slip of the finger that slipped least; in a hand-over, of
                                ///< the one that takes [m]
    double sag = kNone;         ///< hold: lowest height, relative to the start; at most 0 [m]
    double turn = kNone;  ///< hold: turn of the object when the fingers' line had turned most [rad]
    double hand_turn = kNone;       ///< hold: turn of that line [rad]
    double distance = kNone;        ///< slide: length of the path [m]
    double friction_ratio = kNone;  ///< slide: work of friction over its closed form
    double release_speed = kNone;   ///< flight: speed when let go [m/s]
    double release_ratio = kNone;   ///< flight: that velocity along the hand's, over the hand's
    double rise = kNone;            ///< flight: largest height above where it was let go [m]
    double off_path = kNone;        ///< flight: largest distance from the ballistic path [m]

    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
};

/// Properties that the object's mechanics follow from; NaN when not known.
struct ObjectFacts {
    double mass = Episode::kNone;  ///< [kg]
    Vec3 gravity = Vec3::Constant(Episode::kNone);
    std::vector<double> friction;         ///< coefficient with each body of the scene
    std::vector<double> finger_friction;  ///< coefficient with each finger
};

/// Episodes in order of time. A state that lasts less than 20 ms is no episode.
std::vector<Episode> find_episodes(const GraspTrace& trace, const ObjectFacts& object);

}  // namespace dihaptic::analysis
