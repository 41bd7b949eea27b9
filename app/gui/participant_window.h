// The participant's window, which shows only the scene, full screen on a separate monitor.
#pragma once

#include "scene_widget.h"

namespace dihaptic::gui {

/// The character that a key event means to a task: a letter, a digit, or another key with which
/// numbers are typed (point, minus, Enter and Backspace); 0 for any other key.
char task_key(const QKeyEvent& event);

/// Shows a window full screen on the given monitor or, if `monitor` is empty, on a monitor that
/// does not show the operator's window, if there is one. Returns a fault with its remedy, or an
/// empty string.
QString show_on(QWidget& window, const QString& monitor, const QWidget& operator_window);

class ParticipantWindow : public QWidget {
    Q_OBJECT

  public:
    ParticipantWindow();

    SceneWidget& scene() { return *scene_; }

  Q_SIGNALS:
    void closed();
    /// `key`: a letter, a digit, or another character of task_key().
    void key_pressed(char key);

  protected:
    void closeEvent(QCloseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    SceneWidget* scene_;
};

}  // namespace dihaptic::gui
