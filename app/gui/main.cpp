#include <QCommandLineParser>
#include <QFileInfo>
#include <QIcon>
#include <QSettings>
#include <cstdio>

#include "application.h"
#include "base/installed.h"
#include "display_loss.h"
#include "escape_listener.h"
#include "host/at_death.h"
#include "lost_windows.h"
#include "operator_window.h"
#include "recording/session.h"
#include "session_player.h"
#include "stop_request.h"
#include "theme.h"

namespace {

/// Opens windows for recorded sessions only, without the operator's window.
int look_at(const QStringList& folders) {
    try {
        dihaptic::gui::open_sessions(folders);
    } catch (const dihaptic::Error& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 2;
    }
    return QApplication::exec();
}

/// Handles the destruction of a window by another program: a window that nobody can see counts as
/// closed.
void end_unseen(QWidget* gone) {
    if (auto* const window = qobject_cast<dihaptic::gui::OperatorWindow*>(gone)) {
        window->end_unseen();
    } else {
        gone->close();
    }
}

}  // namespace

int main(int argc, char** argv) {
    dihaptic::host::take_force_away_at_death();
    dihaptic::gui::Application app(argc, argv);
    dihaptic::gui::at_display_loss(dihaptic::gui::SessionRunner::end_program);
    QApplication::setOrganizationName("dihaptic");
    QApplication::setApplicationName("dihaptic");
    // name of the package's desktop entry, by which desktops find the icon
    QApplication::setDesktopFileName("org.dihaptic.Dihaptic");
    QApplication::setWindowIcon(QIcon::fromTheme("org.dihaptic.Dihaptic"));
    QApplication::setApplicationVersion(
        QString::fromStdString(dihaptic::recording::program_version()));
    app.translate(QApplication::applicationDirPath() + "/translations");

    QCommandLineParser parser;
    parser.setApplicationDescription(
        "The operator's window: the scene, sessions, live plots, devices, tuning. Without devices, "
        "the mouse moves a simulated hand.\n\nExample:\n  dihaptic gui scenes/block-on-table.yaml");
    parser.addHelpOption();
    parser.addVersionOption();
    const QCommandLineOption out("out", "Folder for session folders.", "folder", "sessions");
    parser.addOption(out);
    const QCommandLineOption sync(
        "sync", "Synchronise recordings to the disk at this interval [s].", "seconds", "0");
    parser.addOption(sync);
    parser.addPositionalArgument(
        "FILE", "scene or experiment, or folders of recorded sessions, of which two are linked",
        "[FILE]");
    parser.process(app);
    QStringList files;
    for (const QString& given : parser.positionalArguments())
        files += QString::fromStdString(dihaptic::given_or_kept(given.toStdString()));
    const QString file = files.value(0);

    dihaptic::gui::LostWindows lost;
    QObject::connect(&lost, &dihaptic::gui::LostWindows::lost, end_unseen);
    dihaptic::gui::set_dark(QSettings().value("dark", false).toBool());
    if (QFileInfo(file).isDir()) return look_at(files);
    if (files.size() > 1) {
        std::fprintf(stderr,
                     "only sessions can be opened together. Name one scene or experiment.\n");
        return 2;
    }
    dihaptic::gui::StopRequest stop;
    dihaptic::gui::OperatorWindow window(parser.value(out), parser.value(sync).toDouble(),
                                         stop.flag());
    QObject::connect(&app, &dihaptic::gui::Application::escape_pressed, &window,
                     &dihaptic::gui::OperatorWindow::force_off);
    QObject::connect(&stop, &dihaptic::gui::StopRequest::came, &window,
                     &dihaptic::gui::OperatorWindow::end);
    dihaptic::gui::EscapeListener escape;
    QObject::connect(&escape, &dihaptic::gui::EscapeListener::heard,
                     &dihaptic::gui::SessionRunner::pause_at_once);
    window.show();
    if (file.isEmpty()) {
        window.show_start_page();
    } else {
        window.open(file);
    }
    return QApplication::exec();
}
