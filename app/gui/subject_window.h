// The subject's window: the scene and nothing else, full screen on a display of its own.
#pragma once

#include "scene_widget.h"

namespace dihaptic::gui {

/// The letter or digit of a key event, for a task, or what a number is typed with besides: point,
/// minus, enter and back; 0 for any other key.
char task_key(const QKeyEvent& event);

class SubjectWindow : public QWidget {
    Q_OBJECT

  public:
    SubjectWindow();

    SceneWidget& scene() { return *scene_; }
    /// Shows it on a display other than the operator's window's, if there is one.
    void show_beside(const QWidget& operator_window);

  Q_SIGNALS:
    void closed();
    /// `key`: a letter or a digit.
    void key_pressed(char key);

  protected:
    void closeEvent(QCloseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    SceneWidget* scene_;
};

}  // namespace dihaptic::gui
