// The subject's window: the scene and nothing else, full screen on a monitor of its own.
#pragma once

#include "scene_widget.h"

namespace dihaptic::gui {

/// The letter or digit of a key event, for a task, or what a number is typed with besides: point,
/// minus, enter and back; 0 for any other key.
char task_key(const QKeyEvent& event);

/// Shows a window on the whole of that monitor or, if `monitor` is empty, of one that the
/// operator's window is not on, if there is one. What is wrong, and what to do, comes back; empty:
/// nothing.
QString show_on(QWidget& window, const QString& monitor, const QWidget& operator_window);

class SubjectWindow : public QWidget {
    Q_OBJECT

  public:
    SubjectWindow();

    SceneWidget& scene() { return *scene_; }

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
