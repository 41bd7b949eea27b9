#include "application.h"

#include <QKeyEvent>
#include <QLibraryInfo>
#include <QLocale>
#include <clocale>

namespace dihaptic::gui {

Application::Application(int& argc, char** argv) : QApplication(argc, argv) {
    std::setlocale(LC_NUMERIC, "C");
}

bool Application::notify(QObject* receiver, QEvent* event) {
    // Qt sends ShortcutOverride before the key press, to ask the widget with the keyboard focus
    // whether to keep a shortcut key for itself
    const bool press =
        event->type() == QEvent::ShortcutOverride || event->type() == QEvent::KeyPress;
    if (press && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) Q_EMIT escape_pressed();
    return QApplication::notify(receiver, event);
}

void Application::translate(const QString& folder) {
    const QLocale language;
    if (!texts_.load(language, "dihaptic", "_", folder)) return;
    installTranslator(&texts_);
    const QString of_qt = QLibraryInfo::path(QLibraryInfo::TranslationsPath);
    if (texts_of_qt_.load(language, "qtbase", "_", of_qt)) installTranslator(&texts_of_qt_);
}

}  // namespace dihaptic::gui
