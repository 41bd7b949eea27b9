#include "subject_window.h"

#include <QCloseEvent>
#include <QGuiApplication>
#include <QScreen>
#include <QVBoxLayout>
#include <QWindow>

namespace dihaptic::gui {

SubjectWindow::SubjectWindow() : scene_(new SceneWidget) {
    setWindowTitle("Dihaptic: subject");
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(scene_);
}

void SubjectWindow::show_beside(const QWidget& operator_window) {
    for (QScreen* screen : QGuiApplication::screens()) {
        if (screen == operator_window.screen()) continue;
        setGeometry(screen->geometry());
        showFullScreen();
        return;
    }
    resize(800, 600);
    show();
}

void SubjectWindow::closeEvent(QCloseEvent* event) {
    event->accept();
    Q_EMIT closed();
}

}  // namespace dihaptic::gui
