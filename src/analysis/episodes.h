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
#include <string>
#include <vector>

#include "analysis/grasp_trace.h"
#include "base/unmeasured.h"

namespace dihaptic::analysis {

enum class EpisodeKind { hold, slide, flight };
constexpr auto enum_names(EpisodeKind) {
    return std::array{"hold", "slide", "flight"};
}

/// One episode, in SI units. Figures that its kind does not have are NaN.
struct Episode {
    EpisodeKind kind = EpisodeKind::hold;
    Range range;  ///< samples of the trace
    double start = 0, end = 0;
    std::vector<size_t> fingers;  ///< fingers that press the object; flight: that let it go
    std::string finger_names;     ///< e.g. "thumb, index"
    double slip = kUnmeasured, least_slip = kUnmeasured, sag = kUnmeasured;
    double turn = kUnmeasured, hand_turn = kUnmeasured;
    double distance = kUnmeasured, friction_ratio = kUnmeasured;
    double release_speed = kUnmeasured, release_ratio = kUnmeasured;
    double rise = kUnmeasured, off_path = kUnmeasured;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("start_time", f.start, "s", "in the session");
        v("stop_time", f.end, "s", "in the session");
        v("episode", f.kind, "", "hold, slide or flight of the object");
        v("fingers", f.finger_names, "", "that pressed it; flight: that let it go");
        v("slip", f.slip, "mm", "hold: largest slip of these fingers on it");
        v("least_slip", f.least_slip, "mm",
          "hold: of the finger that slipped least; in a hand-over, of the one that takes it");
        v("sag", f.sag, "mm", "hold: its lowest height, from that at the start; at most 0");
        v("turn", f.turn, "deg",
          "hold: of the object, when the line between its first two fingers had turned most");
        v("hand_turn", f.hand_turn, "deg", "hold: of that line");
        v("distance", f.distance, "mm", "slide: length of the path");
        v("friction_ratio", f.friction_ratio, "1",
          "slide: work of friction over mu N times the distance, which is 1 for a body that does "
          "not turn, pushed or free");
        v("release_speed", f.release_speed, "m/s", "flight: when let go");
        v("release_ratio", f.release_ratio, "1",
          "flight: that velocity along the mean of the handles that let it go, over that mean");
        v("rise", f.rise, "mm", "flight: largest height above where it was let go");
        v("off_path", f.off_path, "mm",
          "flight: largest distance of its origin from the ballistic path of the first step");
    }
};

/// Properties that the object's mechanics follow from; NaN when not known.
struct ObjectFacts {
    double mass = kUnmeasured;  ///< [kg]
    Vec3 gravity = Vec3::Constant(kUnmeasured);
    std::vector<double> friction;         ///< coefficient with each body of the scene
    std::vector<double> finger_friction;  ///< coefficient with each finger
    bool flies = true;  ///< what nothing touches falls: no joint and no rail holds it
};

/// Episodes in order of time. A state that lasts less than 20 ms is no episode.
std::vector<Episode> find_episodes(const GraspTrace& trace, const ObjectFacts& object);

}  // namespace dihaptic::analysis
