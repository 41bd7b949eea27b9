// Finds the events of a session in its frames: touches and releases, lift-off and replacement of
// the object, phases, and what the servo could not do as asked.
#pragma once

#include <string>
#include <vector>

#include "base/unmeasured.h"
#include "recording/raw_log.h"

namespace dihaptic::analysis {

struct Event {
    int64_t tick = 0;
    double time = 0;  ///< [s]
    int trial = 0;
    std::string name;  ///< "touch", "release", "lift-off", "replaced", "phase", "limit", "setting",
                       ///< "went on"; with a task "trial", "perturbation", "marker", "message",
                       ///< "line", "page", "sound", "put back", "outcome"
    std::string detail;          ///< fingers, bodies or values concerned
    double shown = kUnmeasured;  ///< [s]
    double heard = kUnmeasured;  ///< [s]

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("time", f.time, "s", "of its tick");
        v("trial", f.trial, "1", "number, from 1");
        v("event", f.name, "", "what happened");
        v("detail", f.detail, "", "to whom, or what");
        v("shown", f.shown, "s", "when the first picture of it came to the screen; empty: none");
        v("heard", f.heard, "s", "when the sound left the loudspeaker; empty: it was not played");
    }
};

class EventFinder {
  public:
    /// `object`: index of the body whose lift-off counts; -1 if none. `phases`: their names.
    EventFinder(const recording::LogHead& head, int object, std::vector<std::string> phases);

    /// From the next frame on it is this body whose lift-off counts; it stands at first.
    void follow(int object) noexcept {
        supported_ = true;
        object_ = object;
    }
    void add(const frame::Frame& frame);
    const std::vector<Event>& events() const { return events_; }

  private:
    std::string name(int body) const;
    void say(const frame::Frame& frame, const char* what, std::string detail);
    // each adds the events of its kind that are in this frame
    void add_trial(const frame::Frame& frame);
    void add_task(const frame::Frame& frame);
    void add_texts(const frame::Frame& frame);
    void add_sounds(const frame::Frame& frame);
    void add_phase(const frame::Frame& frame);
    void add_touches(const frame::Frame& frame);
    void add_support(const frame::Frame& frame);
    void add_settings(const frame::Frame& frame);
    void add_status(const frame::Frame& frame);
    /// Whether the object presses on another body than a finger.
    bool on_support(const frame::Frame& frame) const;

    recording::LogHead head_;
    int object_;
    std::vector<std::string> phases_;
    std::vector<char> touching_;      // in the last frame: by finger, by body
    std::vector<char> now_touching_;  // in this frame
    bool seen_ = false;               // there was a frame before this one
    bool supported_ = false;          // on_support() in the last frame
    int trial_ = 0;
    int attempt_ = 0;
    int message_ = -1;
    int page_ = -1;
    std::vector<int32_t> lines_;  // messages below the message, in the last frame
    bool perturbed_ = false;
    size_t placed_ = 0;  // number of bodies
    int phase_ = -1;
    uint32_t status_ = 0;
    frame::Knobs told_;  // values in the last events
    frame::Knobs last_;  // values in the last frame
    std::vector<Event> events_;
};

}  // namespace dihaptic::analysis
