// What the subject sees: the scene and nothing else, full screen on a display of its own.
#pragma once

#include "scene_widget.h"

namespace dihaptic::gui {

class SubjectWindow : public QWidget {
    Q_OBJECT

  public:
    SubjectWindow();

    SceneWidget& scene() { return *scene_; }
    /// On the display that the operator's window is not on, if there is one.
    void show_beside(const QWidget& operator_window);

  Q_SIGNALS:
    void closed();

  protected:
    void closeEvent(QCloseEvent* event) override;

  private:
    SceneWidget* scene_;
};

}  // namespace dihaptic::gui
