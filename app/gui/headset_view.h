// A person's view in a headset: the scene, overlaid with the texts of the task.
#pragma once

#include <QLabel>
#include <QTimer>

#include "headset/headset.h"
#include "page_view.h"

namespace dihaptic::gui {

class HeadsetView : public QObject {
    Q_OBJECT

  public:
    explicit HeadsetView(const display::Headset& place);

    /// Whether the headset's coordinate system has this pose.
    bool is_at(const display::Headset& place) const;
    /// Shows a single, fixed frame of the scene.
    void set_scene(const scene::Scene& scene, const frame::Frame& frame);
    /// Shows the newest of `frames`, which come from a running session of this scene. Nothing else
    /// may read `frames`.
    void follow(const scene::Scene& scene, std::shared_ptr<headset::Headset::Frames> frames);
    /// Makes the frames for a session. Until the session's first frame, the given one is shown.
    static std::shared_ptr<headset::Headset::Frames> frames_from(const frame::Frame& frame);
    void set_banner(const QString& text);
    /// Sets the page shown instead of the scene (page_view.h); if both arguments are empty, the
    /// scene is shown.
    void set_page(const QString& text, const QString& picture);

  Q_SIGNALS:
    /// A message from the headset or its runtime.
    void told(const QString& what, bool problem);
    void shown(const dihaptic::headset::Showing& showing);
    /// The headset has stopped showing pictures; told() has given the reason.
    void ended();

  private:
    void tend();
    void draw_words();

    display::Headset place_;
    QWidget words_;
    PageView* page_;
    QLabel* banner_;
    headset::Headset headset_;
    QTimer timer_;
};

}  // namespace dihaptic::gui
