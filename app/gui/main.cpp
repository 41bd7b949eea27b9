#include <QApplication>
#include <QCommandLineParser>
#include <QFileInfo>
#include <QSettings>

#include "operator_window.h"
#include "recording/session.h"
#include "theme.h"

int main(int argc, char** argv) {
    QApplication app(argc, argv);
    QApplication::setOrganizationName("dihaptic");
    QApplication::setApplicationName("dihaptic");
    QApplication::setApplicationVersion(
        QString::fromStdString(dihaptic::recording::program_version()));

    QCommandLineParser parser;
    parser.setApplicationDescription(
        "The operator's window: the scene, sessions, live plots, devices, tuning. Without devices, "
        "the mouse moves a simulated hand.\n\nExample:\n  dihaptic gui scenes/block-on-table.yaml");
    parser.addHelpOption();
    parser.addVersionOption();
    const QCommandLineOption out("out", "Folder for session folders.", "folder", "sessions");
    parser.addOption(out);
    parser.addPositionalArgument("FILE", "scene or experiment", "[FILE]");
    parser.process(app);

    dihaptic::gui::set_dark(QSettings().value("dark", false).toBool());
    dihaptic::gui::OperatorWindow window(parser.value(out));
    window.show();
    const QString usual = "scenes/block-on-table.yaml";
    if (!parser.positionalArguments().isEmpty()) {
        window.open(parser.positionalArguments().first());
    } else if (QFileInfo::exists(usual)) {
        window.open(usual);
    }
    return QApplication::exec();
}
