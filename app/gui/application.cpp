#include "application.h"

#include <QKeyEvent>

namespace dihaptic::gui {

bool Application::notify(QObject* receiver, QEvent* event) {
    // the first of a press: who has the keyboard is asked whether a shortcut's key is for it
    const bool press =
        event->type() == QEvent::ShortcutOverride || event->type() == QEvent::KeyPress;
    if (press && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) Q_EMIT escape_pressed();
    return QApplication::notify(receiver, event);
}

}  // namespace dihaptic::gui
