// A person's view in a headset: the scene, and over it the task's texts.
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

    /// Whether the headset's space has this pose.
    bool is_at(const display::Headset& place) const;
    /// Shows a fixed frame of the scene.
    void set_scene(const scene::Scene& scene, const frame::Frame& frame);
    /// Shows the newest of `frames`, which come from a running session with this scene. Nothing
    /// else may read them.
    void follow(const scene::Scene& scene, std::shared_ptr<headset::Headset::Frames> frames);
    /// The frames for a session; until its first one, the given frame is shown.
    static std::shared_ptr<headset::Headset::Frames> frames_from(const frame::Frame& frame);
    void set_banner(const QString& text);
    /// Sets the page in place of the scene (page_view.h); empty: none.
    void set_page(const QString& text, const QString& picture);

  Q_SIGNALS:
    /// A message of the headset, or its runtime.
    void told(const QString& what, bool problem);
    void shown(const dihaptic::headset::Showing& showing);
    /// The headset has stopped showing; told() has given the reason.
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
