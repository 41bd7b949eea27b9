// A row of events.csv.
#pragma once

#include <cstdint>
#include <string>

#include "base/unmeasured.h"
#include "rows/row_file.h"

namespace dihaptic::rows {

/// An event in a tick.
struct EventRow {
    int64_t tick = 0;  ///< tick in the log; not in the table
    double time = 0;   ///< [s]
    int trial = 0;
    std::string name;  ///< "touch", "release", "lift-off", "replaced", "phase", "limit", "setting",
                       ///< "went on"; with a task "trial", "perturbation", "marker", "message",
                       ///< "line", "page", "sound", "put back", "answer", "outcome"
    std::string detail;          ///< fingers, bodies or values concerned
    double shown = kUnmeasured;  ///< [s]
    double heard = kUnmeasured;  ///< [s]

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("time", f.time, "s", "time of its tick");
        v("trial", f.trial, "1", "trial number, from 1");
        v("event", f.name, "", "kind of event");
        v("detail", f.detail, "", "fingers, bodies or values concerned");
        v("shown", f.shown, "s", "when its first picture appeared on the screen; empty: none");
        v("heard", f.heard, "s", "when the sound left the loudspeaker; empty: not played");
    }
};

using EventFile = RowFile<EventRow>;

}  // namespace dihaptic::rows
