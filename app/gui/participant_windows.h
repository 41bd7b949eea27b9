// The windows for the participant: one for each display of the rig, besides the view in its
// headset; a rig with neither gets one window.
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
    /// `beside`: the operator's window, whose monitor is avoided if there is another.
    explicit ParticipantWindows(QWidget& beside);

    /// Opens the windows for a rig.
    void open(const rig::Rig& rig);
    void close();
    /// Whether the participant looks at the operator's window.
    bool empty() const { return windows_.empty() && !headset_; }
    /// The participant's main window; null if there is none.
    SceneWidget* first() { return windows_.empty() ? nullptr : &windows_.front()->scene(); }
    HeadsetView* headset() { return headset_.get(); }
    /// Gives the windows a scene, and a rig, which may differ from the last one.
    void set_scene(const scene::Scene& scene, const frame::Frame& frame, const rig::Rig& rig);
    /// Calls f(SceneWidget&) for each.
    template <class F>
    void each(const F& f) {
        for (const auto& window : windows_) f(window->scene());
    }

  Q_SIGNALS:
    /// A different set of windows is open now; there may be none.
    void changed();
    void closed();
    void key_pressed(char key);
    /// A question's line was clicked.
    void clicked(const dihaptic::task::Click& click);
    /// The picture of a tick was handed to the participant's main screen.
    void presented(qint64 tick);
    /// A picture was handed to a headset, or to a screen that is drawn for a tracked head.
    void shown_to_head(const dihaptic::headset::Showing& showing);
    /// The headset has stopped showing.
    void headset_ended();
    /// A monitor is missing, or a headset or tracker has a message.
    void told(const QString& what, bool problem);

  private:
    void add(const std::optional<display::Display>& display);
    void add(const display::Headset& headset);
    void track_head_of(const rig::Rig& rig);
    void track(const std::optional<outlets::TrackedHead>& head);
    /// Gives the windows the newest pose of the head.
    void follow_head();
    void show_first(qint64 tick);

    QWidget& beside_;
    outlets::TrackedHead head_;  // the tracked head
    std::unique_ptr<outlets::HeadTracker> tracker_;
    QTimer follow_;
    std::vector<std::unique_ptr<ParticipantWindow>> windows_;
    std::unique_ptr<HeadsetView> headset_;
};

}  // namespace dihaptic::gui
