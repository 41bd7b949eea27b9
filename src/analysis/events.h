// Finds the events of a session in its frames: touches and releases, lift-off and replacement of
// the object, phase changes, and servo faults.
#pragma once

#include <string>
#include <vector>

#include "recording/raw_log.h"
#include "rows/event_row.h"

namespace dihaptic::analysis {

class EventFinder {
  public:
    /// `object`: index of the body whose lift-off is reported; -1 if none. `phases`: names of the
    /// phases.
    EventFinder(const recording::LogHead& head, int object, std::vector<std::string> phases);

    /// From the next frame on, reports the lift-off of this body, which must be standing on its
    /// support.
    void follow(int object) noexcept {
        supported_ = true;
        object_ = object;
    }
    void add(const frame::Frame& frame);
    const std::vector<rows::EventRow>& events() const { return events_; }

  private:
    std::string name(int body) const;
    void say(const frame::Frame& frame, const char* what, std::string detail);
    // each function adds this frame's events of one kind
    void add_trial(const frame::Frame& frame);
    void add_task(const frame::Frame& frame);
    void add_texts(const frame::Frame& frame);
    void add_sounds(const frame::Frame& frame);
    void add_answers(const frame::Frame& frame);
    void add_phase(const frame::Frame& frame);
    void add_touches(const frame::Frame& frame);
    void add_support(const frame::Frame& frame);
    void add_settings(const frame::Frame& frame);
    void add_status(const frame::Frame& frame);
    /// Whether the object presses on a body other than a finger.
    bool on_support(const frame::Frame& frame) const;

    recording::LogHead head_;
    int object_;
    std::vector<std::string> phases_;
    std::vector<char> touching_;      // touches in the last frame, indexed by finger, then by body
    std::vector<char> now_touching_;  // touches in this frame
    bool seen_ = false;               // whether there was a previous frame
    bool supported_ = false;          // on_support() in the previous frame
    int trial_ = 0;
    int attempt_ = 0;
    int message_ = -1;
    int page_ = -1;
    std::vector<int32_t> lines_;   // lines below the message in the last frame
    std::vector<double> answers_;  // answers at the end of the last state [SI]
    bool perturbed_ = false;
    size_t placed_ = 0;  // number of bodies placed in the last frame
    int phase_ = -1;
    uint32_t status_ = 0;
    frame::Knobs told_;  // values that were last reported
    frame::Knobs last_;  // values in the last frame
    std::vector<rows::EventRow> events_;
};

}  // namespace dihaptic::analysis
