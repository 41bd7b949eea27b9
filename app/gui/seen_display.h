// A display as the eyes in front of it see it now: its eyes may be tracked, and it may show both
// eyes' pictures in turn.
#pragma once

#include <QElapsedTimer>
#include <optional>

#include "display/display.h"
#include "outlets/head_tracker.h"

namespace dihaptic::gui {

class SeenDisplay {
  public:
    /// Sets the display; nullopt if the scene is drawn from a camera.
    void set(const std::optional<display::Display>& display) { display_ = display; }
    explicit operator bool() const { return display_.has_value(); }
    /// Sets the pose of the head. Returns whether the picture changes with it.
    bool set_head(const outlets::HeadPose& head);

    /// Returns the display with the current position of its eyes, for a picture that is now drawn.
    /// A head position behind the screen, or nearly touching it, is ignored, because nothing could
    /// be drawn for it.
    display::Display now();
    /// The pose of the head for which the last picture was drawn; nullopt if the eyes were at rest.
    const std::optional<outlets::HeadPose>& shown_to() const { return shown_to_; }
    /// To be called before a picture that is not drawn for any eyes.
    void forget_head() { shown_to_.reset(); }

    /// Determines which eye's picture is next after one has appeared on the screen. The glasses
    /// alternate between the eyes even if a picture is late, so the number of refreshes since the
    /// last picture is counted. Returns false if the eyes do not take turns. `refresh_rate` is in
    /// [Hz].
    bool take_turns(double refresh_rate);

  private:
    std::optional<display::Display> display_;
    std::optional<outlets::HeadPose> head_, shown_to_;
    bool right_eye_ = false;  // whether the right eye's picture is next
    QElapsedTimer since_swap_;
};

}  // namespace dihaptic::gui
