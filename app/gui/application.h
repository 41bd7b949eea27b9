// The Qt application object, which sees Escape before any widget: a dialog, a menu or a field that
// has the keyboard would use the key up.
#pragma once

#include <QApplication>

namespace dihaptic::gui {

class Application : public QApplication {
    Q_OBJECT

  public:
    using QApplication::QApplication;
    bool notify(QObject* receiver, QEvent* event) override;

  Q_SIGNALS:
    /// Sent before the key has any other effect; may be sent more than once for a press.
    void escape_pressed();
};

}  // namespace dihaptic::gui
