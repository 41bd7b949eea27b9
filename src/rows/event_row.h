// A row of events.csv.
#pragma once

#include <cstdint>
#include <string>

#include "base/unmeasured.h"
#include "rows/row_file.h"

namespace dihaptic::rows {

/// Version of the HED schema (www.hedtags.org) that defines the tags.
inline constexpr const char* kHedSchema = "8.3.0";

/// Name of the event that contains a note of the operator. The note may name a person, so that
/// files meant to be shared leave it out.
inline constexpr const char* kNote = "note";

struct EventKind {
    const char* name;
    const char* value;  ///< what the event's detail means
    const char* hed;    ///< HED tags of the event
};
inline constexpr EventKind kEventKinds[] = {
    {"trial", "the attempt's number", "Experiment-structure, Experimental-trial"},
    {"phase", "the state that began", "Experiment-structure, Task-activity"},
    {"outcome", "how the trial ended", "Experiment-structure, Task-effect-evidence"},
    {"answer", "the answer's column and number, and its form with the version",
     "Agent-action, Experiment-participant, Participant-response"},
    {"message", "message shown to the participant",
     "Sensory-event, Visual-presentation, Instructional"},
    {"line", "line shown to the participant below the message",
     "Sensory-event, Visual-presentation, Instructional"},
    {"page", "text or picture of the page shown",
     "Sensory-event, Visual-presentation, Instructional"},
    {"sound", "the sound that began", "Sensory-event, Auditory-presentation"},
    {"sound ends", "the sound that ended", "Experiment-control, Auditory-presentation"},
    {"marker", "the code sent", "Experiment-control"},
    {"perturbation", "on or off", "Experiment-control"},
    {"put back", "number of bodies placed", "Experiment-control"},
    {"setting", "the setting and its new value", "Experiment-control"},
    {kNote, "what the operator wrote, at the time when the operator began to write",
     "Experiment-control"},
    {"paused", "effect of the pause", "Experiment-control"},
    {"went on", "the interruption after which it went on", "Experiment-control"},
    {"touch", "the finger, and the object touched", "Agent-action, Experiment-participant, Touch"},
    {"release", "the finger, and the object released",
     "Agent-action, Experiment-participant, Release"},
    {"lift-off", "the object", "Agent-action, Experiment-participant, Lift"},
    {"replaced", "the object", "Agent-action, Experiment-participant, Task-activity"},
    {"limit", "the limit that was reached", "Data-feature"},
};

/// An event that occurred in a tick.
struct EventRow {
    int64_t tick = 0;  ///< tick in the log; not written to the table
    double time = 0;   ///< [s]
    int trial = 0;
    std::string name;            ///< name of one of kEventKinds
    std::string detail;          ///< the fingers, bodies or values involved
    double shown = kUnmeasured;  ///< [s]
    double heard = kUnmeasured;  ///< [s]

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("time", f.time, "s", "time of its tick");
        v("trial", f.trial, "1", "trial number, from 1");
        v("event", f.name, "", "kind of event");
        v("detail", f.detail, "", "fingers, bodies or values concerned");
        v("shown", f.shown, "s",
          "when the first picture of the event appeared on the screen; empty: none");
        v("heard", f.heard, "s", "when the sound left the loudspeaker; empty: not played");
    }
};

using EventFile = RowFile<EventRow>;

}  // namespace dihaptic::rows
