#include "shelf.h"

#include <sys/resource.h>

#include <QCoreApplication>
#include <QCryptographicHash>
#include <QDir>
#include <QFileInfo>
#include <QStandardPaths>

#include "base/node.h"
#include "edited_file.h"
#include "main_program.h"
#include "session/plan.h"

namespace dihaptic::gui {
namespace {

/// The duration of the file's session as text; empty if it is unknown.
QString length_of(const session::Plan& plan) {
    if (plan.task) {
        const auto trials = plan.task->trials.size();
        return trials == 1 ? QObject::tr("1 trial") : QObject::tr("%1 trials").arg(trials);
    }
    if (plan.open_ended()) return "";
    return QString("%1 s").arg(plan.driver->duration(), 0, 'f', 0);
}

/// The title that a file gives itself, which is found much sooner than its plan; empty if there is
/// none.
QString title_in(const QString& file) {
    try {
        const Node yaml = read_yaml(file.toStdString());
        const Node* const title = yaml.find("title");
        return title == nullptr ? "" : QString::fromStdString(title->scalar);
    } catch (const Error&) {
        return "";
    }
}

}  // namespace

Shelf::~Shelf() {
    stop();
}

QString Shelf::picture_of(const QString& file) {
    QCryptographicHash hash(QCryptographicHash::Sha1);
    // an experiment's picture also depends on its scene, but a change of the scene goes unnoticed
    // here; for a small picture it is enough that the key contains the program's version
    hash.addData(bytes_of(file).value_or(QByteArray()));
    hash.addData(QFileInfo(file).absoluteFilePath().toUtf8());
    hash.addData(QCoreApplication::applicationVersion().toUtf8());
    const QString folder =
        QStandardPaths::writableLocation(QStandardPaths::CacheLocation) + "/pictures";
    QDir().mkpath(folder);
    return folder + "/" + QString::fromLatin1(hash.result().toHex()) + ".png";
}

void Shelf::read(const QStringList& files) {
    stop();
    to_draw_ = files;
    thread_ = std::jthread([this, files](const std::stop_token& stop) {
        const auto tell = [this](const QString& file, const QString& title, const QString& length) {
            QMetaObject::invokeMethod(
                this, [=, this] { Q_EMIT told(file, title, length); }, Qt::QueuedConnection);
        };
        for (const QString& file : files) {
            if (stop.stop_requested()) return;
            tell(file, title_in(file), "");
        }
        for (const QString& file : files) {
            if (stop.stop_requested()) return;
            session::Request request;
            request.file = file.toStdString();
            request.participant = "S01";
            request.simulate = true;
            request.stop = stop;
            QString title;
            QString length;
            try {
                const session::Plan plan = session::make_plan(request);
                title = QString::fromStdString(plan.title);
                length = length_of(plan);
            } catch (const std::exception&) {
                title = tr("Has a fault, which is reported when the file is opened.");
            }
            tell(file, title, length);
        }
    });
    draw_next();
}

void Shelf::draw_next() {
    const QString dihaptic = main_program();
    while (!to_draw_.isEmpty()) {
        const QString file = to_draw_.takeFirst();
        const QString picture = picture_of(file);
        if (QFileInfo::exists(picture)) {
            Q_EMIT drawn(file, picture);
            continue;
        }
        if (dihaptic.isEmpty()) {
            to_draw_.clear();
            return Q_EMIT cannot_draw(
                tr("There are no pictures of files. %1").arg(main_program_is_missing()));
        }
        drawing_ = new QProcess(this);
        connect(drawing_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
            if (error != QProcess::FailedToStart) return;
            Q_EMIT cannot_draw(tr("There are no pictures of files: %1 cannot be started: %2.")
                                   .arg(drawing_->program(), drawing_->errorString()));
            drawing_->deleteLater();
            drawing_ = nullptr;
            to_draw_.clear();
        });
        connect(drawing_, &QProcess::finished, this, [=, this](int code) {
            drawing_->deleteLater();
            drawing_ = nullptr;
            if (code == 0) Q_EMIT drawn(file, picture);
            draw_next();
        });
        drawing_->setStandardErrorFile(QProcess::nullDevice());
        // the picture is not urgent, so the window and other programs have priority; at 19, it
        // would take minutes on a busy computer
        drawing_->setChildProcessModifier([] { setpriority(PRIO_PROCESS, 0, 10); });
        drawing_->start(dihaptic, {"picture", file, "--size", "480x300", "-o", picture});
        return;
    }
}

void Shelf::stop() {
    to_draw_.clear();
    if (drawing_ != nullptr) {
        drawing_->disconnect(this);
        drawing_->kill();
        drawing_->waitForFinished();
        delete drawing_;
        drawing_ = nullptr;
    }
    thread_ = {};  // requests the thread to stop, and waits for it
}

}  // namespace dihaptic::gui
