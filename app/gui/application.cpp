#include "application.h"

#include <QKeyEvent>

namespace dihaptic::gui {

bool Application::notify(QObject* receiver, QEvent* event) {
    // ShortcutOverride comes first: it asks the widget with the keyboard focus whether to keep a
    // shortcut's key for itself
    const bool press =
        event->type() == QEvent::ShortcutOverride || event->type() == QEvent::KeyPress;
    if (press && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) Q_EMIT escape_pressed();
    return QApplication::notify(receiver, event);
}

}  // namespace dihaptic::gui
