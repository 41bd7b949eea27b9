// The participant's windows: one for each display of the rig, in addition to the view in a headset.
// A rig with neither displays nor a headset gets one window.
#pragma once

#include <QTimer>
#include <memory>
#include <vector>

#include "headset_view.h"
#include "participant_window.h"
#include "rig/rig.h"

namespace dihaptic::gui {

class ParticipantWindows : public QObject {
    Q_OBJECT

  public:
    /// `beside`: the operator's window. Its monitor is avoided if there is another.
    explicit ParticipantWindows(QWidget& beside);

    /// Opens the windows that a rig needs.
    void open(const rig::Rig& rig);
    void close();
    /// Whether there is no window or headset, so that the participant looks at the operator's
    /// window.
    bool empty() const { return windows_.empty() && !headset_; }
    /// The scene in the participant's main window; null if there is no window.
    SceneWidget* first() { return windows_.empty() ? nullptr : &windows_.front()->scene(); }
    HeadsetView* headset() { return headset_.get(); }
    /// Passes a scene and a rig, which may differ from the previous ones, to the windows.
    void set_scene(const scene::Scene& scene, const frame::Frame& frame, const rig::Rig& rig);
    /// Calls f(SceneWidget&) for each window.
    template <class F>
    void each(const F& f) {
        for (const auto& window : windows_) f(window->scene());
    }

  Q_SIGNALS:
    /// The set of open windows has changed; it may be empty.
    void changed();
    void closed();
    void key_pressed(char key);
    /// The line of a question was clicked.
    void clicked(const dihaptic::task::Click& click);
    /// The picture of a tick was passed to the participant's main screen.
    void presented(qint64 tick);
    /// A picture was passed to a headset, or to a screen that is drawn for a tracked head.
    void shown_to_head(const dihaptic::headset::Showing& showing);
    /// The headset has stopped showing pictures.
    void headset_ended();
    /// A monitor is missing, or the headset or the tracker has sent a message.
    void told(const QString& what, bool problem);

  private:
    void add(const std::optional<display::Display>& display);
    void add(const display::Headset& headset);
    void track_head_of(const rig::Rig& rig);
    void track(const std::optional<outlets::TrackedHead>& head);
    /// Passes the newest pose of the head to the windows.
    void follow_head();
    void show_first(qint64 tick);

    QWidget& beside_;
    outlets::TrackedHead head_;  // description of the tracked head
    std::unique_ptr<outlets::HeadTracker> tracker_;
    QTimer follow_;
    std::vector<std::unique_ptr<ParticipantWindow>> windows_;
    std::unique_ptr<HeadsetView> headset_;
};

}  // namespace dihaptic::gui
