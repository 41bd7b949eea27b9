// A small copy of the participant's view for the operator: the picture in the participant's first
// window, including texts.
#pragma once

#include <QPixmap>
#include <QPointer>
#include <QTimer>

#include "scene_widget.h"

namespace dihaptic::gui {

class ParticipantMirror : public QWidget {
    Q_OBJECT

  public:
    ParticipantMirror();

    /// Mirrors `scene`, the widget in the participant's first window. If it is null because there
    /// is no such window, shows `why` instead.
    void follow(SceneWidget* scene, const QString& why);

    QSize sizeHint() const override { return {320, 200}; }

  protected:
    void paintEvent(QPaintEvent* event) override;
    void showEvent(QShowEvent* event) override;

  private:
    /// Takes a new picture if the mirror is visible.
    void look();

    QPointer<SceneWidget> scene_;
    QString why_;
    QTimer wait_;  // waiting time between two pictures
    QPixmap picture_;
};

}  // namespace dihaptic::gui
