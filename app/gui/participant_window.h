// The participant's window: the scene and nothing else, full screen on a separate monitor.
#pragma once

#include "scene_widget.h"

namespace dihaptic::gui {

/// The letter or digit of a key event, for a task, or another key with which numbers are typed:
/// point, minus, Enter and Backspace; 0 for any other key.
char task_key(const QKeyEvent& event);

/// Shows a window in full screen on that monitor or, if `monitor` is empty, on a monitor without
/// the operator's window, if there is one. Returns a fault with its remedy; empty if there is none.
QString show_on(QWidget& window, const QString& monitor, const QWidget& operator_window);

class ParticipantWindow : public QWidget {
    Q_OBJECT

  public:
    ParticipantWindow();

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
