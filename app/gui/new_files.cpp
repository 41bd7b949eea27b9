#include "new_files.h"

#include <QDir>
#include <QFileDialog>
#include <QProcess>

#include "main_program.h"

namespace dihaptic::gui {
namespace {

/// The word of `dihaptic new` for a kind of file.
QString word_of(NewFiles::Kind kind) {
    switch (kind) {
        case NewFiles::Kind::scene:
            return "scene";
        case NewFiles::Kind::experiment:
            return "experiment";
        default:
            return "study";
    }
}

}  // namespace

QString NewFiles::ask(Kind kind, const QString& folder) {
    const bool is_study = kind == Kind::study;
    const QString title = is_study ? tr("New study: the name of its folder")
                          : kind == Kind::scene
                              ? tr("New scene: the name of its file")
                              : tr("New experiment: the name of its file, in the study's folder");
    const QString usual = QDir(folder).filePath("my-" + word_of(kind) + (is_study ? "" : ".yaml"));
    QString path = QFileDialog::getSaveFileName(
        window_, title, usual, is_study ? tr("Folders") : tr("Scenes and experiments (*.yaml)"),
        nullptr, QFileDialog::DontConfirmOverwrite);
    if (!path.isEmpty() && !is_study && !path.endsWith(".yaml")) path += ".yaml";
    return path;
}

void NewFiles::make(Kind kind, const QString& folder) {
    const QString path = ask(kind, folder);
    if (!path.isEmpty()) run(kind, path);
}

void NewFiles::run(Kind kind, const QString& path) {
    const QString dihaptic = main_program();
    if (dihaptic.isEmpty()) return Q_EMIT failed(main_program_is_missing());
    auto* program = new QProcess(this);
    connect(program, &QProcess::finished, this, [=, this](int code) {
        program->deleteLater();
        if (code != 0)
            return Q_EMIT failed(QString::fromUtf8(program->readAllStandardError()).trimmed());
        Q_EMIT made(kind == Kind::study ? path + "/experiment.yaml" : path);
    });
    connect(program, &QProcess::errorOccurred, this, [this, program](QProcess::ProcessError error) {
        if (error != QProcess::FailedToStart) return;
        Q_EMIT failed(
            tr("%1 cannot be started: %2.").arg(program->program(), program->errorString()));
        program->deleteLater();
    });
    program->start(dihaptic, {"new", word_of(kind), path});
}

}  // namespace dihaptic::gui
