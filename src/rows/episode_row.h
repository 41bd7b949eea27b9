// A row of episodes.csv. analysis/episodes.h describes how episodes are found.
#pragma once

#include <array>
#include <string>

#include "base/unmeasured.h"
#include "rows/row_file.h"

namespace dihaptic::rows {

enum class EpisodeKind { hold, slide, flight };
constexpr auto enum_names(EpisodeKind) {
    return std::array{"hold", "slide", "flight"};
}

/// One episode, in SI units. Figures that do not apply to this kind of episode are NaN.
struct EpisodeRow {
    EpisodeKind kind = EpisodeKind::hold;
    double start = 0, end = 0;
    std::string finger_names;  ///< e.g. "thumb, index"
    double slip = kUnmeasured, least_slip = kUnmeasured, sag = kUnmeasured;
    double turn = kUnmeasured, hand_turn = kUnmeasured;
    double distance = kUnmeasured, friction_ratio = kUnmeasured;
    double release_speed = kUnmeasured, release_ratio = kUnmeasured;
    double rise = kUnmeasured, off_path = kUnmeasured;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("start_time", f.start, "s", "from the session's start");
        v("stop_time", f.end, "s", "from the session's start");
        v("episode", f.kind, "", "hold, slide or flight of the object");
        v("fingers", f.finger_names, "",
          "fingers that pressed the object; flight: fingers that released it");
        v("slip", f.slip, "mm", "hold: largest slip of these fingers on the object");
        v("least_slip", f.least_slip, "mm",
          "hold: slip of the finger that slipped least; in a hand-over, slip of the receiving "
          "finger");
        v("sag", f.sag, "mm",
          "hold: lowest height of the object, relative to the start; at most 0");
        v("turn", f.turn, "deg",
          "hold: turn of the object when the line between its first two fingers had turned most");
        v("hand_turn", f.hand_turn, "deg", "hold: turn of the line between the first two fingers");
        v("distance", f.distance, "mm", "slide: length of the path");
        v("friction_ratio", f.friction_ratio, "1",
          "slide: ratio of the work of friction to mu N times the distance; 1 for a body that does "
          "not turn, pushed or free; empty while fingers carry most of the body");
        v("release_speed", f.release_speed, "m/s", "flight: speed at release");
        v("release_ratio", f.release_ratio, "1",
          "flight: component of the release velocity along the mean velocity of the releasing "
          "handles, over the magnitude of that mean");
        v("rise", f.rise, "mm", "flight: largest height above the point of release");
        v("off_path", f.off_path, "mm",
          "flight: largest distance of the object's origin from the ballistic path of the first "
          "step");
    }
};

using EpisodeFile = RowFile<EpisodeRow>;

}  // namespace dihaptic::rows
