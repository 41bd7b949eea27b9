// What was done with the object, told from the frames alone: held, slid on something, in flight;
// with the figures that mechanics has a closed form for.
//
// hold    fingers press it and nothing else does. How far they slipped, how far it sank, and how
//         far it turned with the line between the first two of them.
// slide   it moves along what it lies on. With F the fingers' forces on it, n the support's normal,
//         N = -(F + m g) . n, and v the velocity at the contact, work balances:
//
//             sum h (F + m g) . v + m (v_start^2 - v_end^2) / 2 = mu sum h N |v|
//
//         `friction_ratio` is left over right: 1 while it does not turn. A block let go at v stops
//         within v^2 / (2 mu g); one that is pushed steadily takes mu m g.
// flight  nothing touches it. Its velocity when let go over the hand's (the mean of the handles
//         that let go, along it), and its largest distance from the parabola of its first step.
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

/// Figures that an episode's kind has not are NaN.
struct Episode {
    EpisodeKind kind = EpisodeKind::hold;
    Range range;                  ///< of the trace's samples
    double start = 0;             ///< [s]
    double end = 0;               ///< [s]
    std::vector<size_t> fingers;  ///< that press it; flight: that let it go
    double slip = kNone;          ///< hold: largest of these fingers on the object [m]
    double least_slip = kNone;    ///< of the finger that slipped least: who takes the object over
    double sag = kNone;           ///< hold: lowest height, from that at the start; at most 0 [m]
    double turn = kNone;  ///< hold: of the object, when the fingers' line had turned most [rad]
    double hand_turn = kNone;       ///< of that line [rad]
    double distance = kNone;        ///< slide [m]
    double friction_ratio = kNone;  ///< slide: work of friction over its closed form
    double release_speed = kNone;   ///< flight: when let go [m/s]
    double release_ratio = kNone;   ///< along the hand's velocity, over it
    double rise = kNone;            ///< flight: above where it was let go [m]
    double off_path = kNone;        ///< flight: from the ballistic path [m]

    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
};

/// What the object's mechanics follow from; NaN when not known.
struct ObjectFacts {
    double mass = Episode::kNone;  ///< [kg]
    Vec3 gravity = Vec3::Constant(Episode::kNone);
    std::vector<double> friction;         ///< between the object and each body of the scene
    std::vector<double> finger_friction;  ///< and each finger
};

/// In order of time. What lasts less than 20 ms is none.
std::vector<Episode> find_episodes(const GraspTrace& trace, const ObjectFacts& object);

}  // namespace dihaptic::analysis
