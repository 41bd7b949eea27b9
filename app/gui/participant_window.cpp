#include "participant_window.h"

#include <QCloseEvent>
#include <QGuiApplication>
#include <QKeyEvent>
#include <QScreen>
#include <QVBoxLayout>
#include <QWindow>

namespace dihaptic::gui {

char task_key(const QKeyEvent& event) {
    const QString text = event.text();
    if (event.isAutoRepeat() || text.size() != 1 || text[0].unicode() > 127) return 0;
    // other keys needed to type numbers
    if (QStringLiteral(".-\r\b").contains(text[0])) return text[0].toLatin1();
    if (text[0] == ',') return '.';  // comma on the numeric keypad of some keyboards
    return text[0].isLetterOrNumber() ? text[0].toLatin1() : '\0';
}

ParticipantWindow::ParticipantWindow() : scene_(new SceneWidget) {
    setWindowTitle(tr("Dihaptic: participant"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(scene_);
}

QString show_on(QWidget& window, const QString& monitor, const QWidget& operator_window) {
    QStringList names;
    for (QScreen* screen : QGuiApplication::screens()) {
        names += screen->name();
        const bool wanted =
            monitor.isEmpty() ? screen != operator_window.screen() : screen->name() == monitor;
        if (!wanted) continue;
        window.setGeometry(screen->geometry());
        window.showFullScreen();
        return "";
    }
    window.resize(800, 600);
    window.show();
    if (monitor.isEmpty()) return "";
    return QObject::tr("there is no monitor '%1'; there are %2. Name one of these in the rig file.")
        .arg(monitor, names.join(", "));
}

void ParticipantWindow::keyPressEvent(QKeyEvent* event) {
    if (const char key = task_key(*event); key != 0) Q_EMIT key_pressed(key);
}

void ParticipantWindow::closeEvent(QCloseEvent* event) {
    event->accept();
    Q_EMIT closed();
}

}  // namespace dihaptic::gui
