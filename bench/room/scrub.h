// The command `dihaptic-bench scrub`: measures the time of the player's jump to any moment of a
// recorded session. docs/measures.md defines the figures.
#pragma once

#include <string>

#include "measure/grasp.h"

namespace dihaptic::bench {

struct ScrubFigures {
    double duration = 0;
    double open_ms = 0;
    double jump_ms = 0;
    double worst_jump_ms = 0;
    double next_us = 0;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("duration", f.duration, "s", "of the session");
        v("open_ms", f.open_ms, "ms", "until its log can be browsed");
        v("jump_ms", f.jump_ms, "ms", "to a random moment, median");
        v("worst_jump_ms", f.worst_jump_ms, "ms", "to a random moment, at worst");
        v("next_us", f.next_us, "us", "to the next tick, median");
    }
};

/// Throws Error if the session has no log.
ScrubFigures bench_scrub(const std::string& session, const measure::Progress& progress);

}  // namespace dihaptic::bench
