// The program's Qt, which sees Escape before anything else does: a dialog, a menu or a field that
// has the keyboard would use it up.
#pragma once

#include <QApplication>

namespace dihaptic::gui {

class Application : public QApplication {
    Q_OBJECT

  public:
    using QApplication::QApplication;
    bool notify(QObject* receiver, QEvent* event) override;

  Q_SIGNALS:
    /// Before it does what else it does; more than once a press.
    void escape_pressed();
};

}  // namespace dihaptic::gui
