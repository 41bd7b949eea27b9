// The windows that the subject looks at: one for each display of the rig, or one without a display.
#pragma once

#include <memory>
#include <vector>

#include "rig/display.h"
#include "scene/scene.h"
#include "subject_window.h"

namespace dihaptic::gui {

class SubjectWindows : public QObject {
    Q_OBJECT

  public:
    /// `beside`: the operator's window, on whose monitor none is opened if there is another.
    explicit SubjectWindows(QWidget& beside) : beside_(beside) {}

    /// Opens one for each display; without any, one all the same.
    void open(const std::vector<rig::Display>& displays);
    void close() { windows_.clear(); }
    bool empty() const { return windows_.empty(); }
    /// The scene that the subject looks at first of all; only unless it is empty.
    SceneWidget& first() { return windows_.front()->scene(); }
    /// Gives them a scene, and the displays of a rig that may be another one.
    void set_scene(const scene::Scene& scene, const servo::Frame& frame,
                   const std::vector<rig::Display>& displays);
    /// Calls f(SceneWidget&) for each.
    template <class F>
    void each(const F& f) {
        for (const auto& window : windows_) f(window->scene());
    }

  Q_SIGNALS:
    void closed();
    void key_pressed(char key);
    /// A question's line was clicked at a share of its length.
    void clicked(double share);
    /// The picture of a tick was handed to the screen that the subject looks at first of all.
    void presented(qint64 tick);
    /// A monitor is not there.
    void complained(const QString& what);

  private:
    void add(const std::optional<rig::Display>& display);

    QWidget& beside_;
    std::vector<std::unique_ptr<SubjectWindow>> windows_;
};

}  // namespace dihaptic::gui
