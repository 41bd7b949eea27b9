// The operator's window: the open file, and opening others.
#include "operator_window.h"

#include <QDir>
#include <QDockWidget>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>
#include <QMessageBox>
#include <cstdio>
#include <utility>

#include "session_player.h"
#include "sessions_dialog.h"

namespace dihaptic::gui {

void OperatorWindow::connect_files() {
    connect(composer_, &Composer::edited, this, &OperatorWindow::reload);
    connect(composer_, &Composer::saved, this, &OperatorWindow::reload);
    connect(composer_, &Composer::told, this, [this](const QString& text) { log(text, true); });
    connect(composer_, &Composer::draft_taken, compose_dock_, &QWidget::show);
    connect(composer_, &Composer::modified, save_action_, &QAction::setEnabled);
    connect(composer_, &Composer::undo_available, undo_action_, &QAction::setEnabled);
    connect(composer_, &Composer::redo_available, redo_action_, &QAction::setEnabled);
    connect(composer_, &Composer::cursor_moved, this, &OperatorWindow::mark_picked);
    connect(composer_, &Composer::step_wanted, this, [this](const QKeyEvent& event) {
        if (const auto step = step_of(event, scene_->camera())) step_body(*step);
    });
    connect(compose_dock_, &QDockWidget::visibilityChanged, this, &OperatorWindow::mark_picked);
    connect(start_page_, &StartPage::chosen, this, &OperatorWindow::open);
    connect(start_page_, &StartPage::open_requested, this, &OperatorWindow::choose_file);
    connect(start_page_, &StartPage::sessions_requested, this, &OperatorWindow::choose_session);
    connect(calibrator_, &Calibrator::logged, this, &OperatorWindow::log);
    connect(calibrator_, &Calibrator::stored, this, &OperatorWindow::reload);
    connect(&loader_, &Loader::opened, this, &OperatorWindow::opened);
    connect(&loader_, &Loader::refused, this, &OperatorWindow::refused);
    // emitted by the loader's thread, so it arrives later, when loading may be over
    connect(&loader_, &Loader::waits, this, [this](const QString& what, int seconds, int most) {
        if (loader_.loading())
            session_->set_progress(most > 0 ? static_cast<double>(seconds) / most : 0,
                                   tr("%1: %2 s of %3 s at most").arg(what).arg(seconds).arg(most));
    });
    reload_.setSingleShot(true);
    connect(&watcher_, &QFileSystemWatcher::fileChanged, this, [this] { reload_.start(300); });
    // a missing file has returned
    connect(&watcher_, &QFileSystemWatcher::directoryChanged, this, [this] {
        if (!watcher_.files().contains(file_) && QFileInfo::exists(file_)) reload_.start(300);
    });
    connect(&reload_, &QTimer::timeout, this, &OperatorWindow::reload);
}

void OperatorWindow::choose_file() {
    // loading that ends while the dialog is open must not start a session
    start_when_opened_ = false;
    starts_.reset();
    const QString start = file_.isEmpty() ? QString("experiments") : QFileInfo(file_).path();
    const QString file = QFileDialog::getOpenFileName(this, tr("Open a scene or an experiment"),
                                                      start, tr("Scenes and experiments (*.yaml)"));
    if (!file.isEmpty()) open(file);
}

void OperatorWindow::save_as() {
    if (file_.isEmpty() || !open_action_->isEnabled()) return;
    const QString file = QFileDialog::getSaveFileName(this, tr("Save as"), file_,
                                                      tr("Scenes and experiments (*.yaml)"));
    if (!file.isEmpty() && composer_->save_as(file)) open(file);
}

void OperatorWindow::choose_session() {
    auto* dialog = new SessionsDialog(out_, this);
    connect(dialog, &SessionsDialog::chosen, this, &OperatorWindow::play_sessions);
    dialog->open();
}

void OperatorWindow::play_sessions(const QStringList& folders) {
    try {
        open_sessions(folders);
    } catch (const Error& e) {
        log(e.what(), true);
    }
}

session::Request OperatorWindow::request(const QString& file) const {
    session::Request request;
    request.file = file.toStdString();
    request.rig = session_->rig().toStdString();
    request.mouse = session_->hand() == SessionPanel::Hand::mouse;
    request.simulate = session_->hand() == SessionPanel::Hand::person;
    request.participant = session_->participant().toStdString();
    // for showing a file that requires a participant; a session has its own
    if (request.participant.empty()) request.participant = "S01";
    request.set.emplace_back("proxy.changeable=yes");
    return request;
}

void OperatorWindow::show_start_page() {
    if (!open_action_->isEnabled()) return;
    start_page_->fill();
    centre_->setCurrentWidget(start_page_);
}

bool OperatorWindow::may_leave_text() {
    if (!composer_->changed()) return true;
    const auto answer = QMessageBox::question(
        this, tr("Save?"), tr("%1 has changes that were not saved.").arg(file_),
        QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
    if (answer == QMessageBox::Save) return composer_->save();
    if (answer == QMessageBox::Discard) composer_->forget();
    return answer == QMessageBox::Discard;
}

void OperatorWindow::leave_text() {
    if (!composer_->changed()) return;
    std::fprintf(stderr, composer_->leave_draft()
                             ? "unsaved text is offered when the file is opened\n"
                             : "unsaved text is lost\n");
}

void OperatorWindow::open(const QString& file) {
    if (!may_leave_text()) return;
    composer_->forget();
    start_page_->rest();
    centre_->setCurrentWidget(scene_);
    file_ = file;
    starts_.reset();
    recorded_.clear();
    if (const QStringList watched = watcher_.files() + watcher_.directories(); !watched.isEmpty())
        watcher_.removePaths(watched);
    watcher_.addPath(file);
    watcher_.addPath(QFileInfo(file).absolutePath());
    QStringList rigs;
    for (const QFileInfo& rig :
         QDir(QFileInfo(file).dir().filePath("../rigs")).entryInfoList({"*.yaml"}))
        rigs += rig.filePath();
    session_->set_rigs(rigs);
    reload();
}

void OperatorWindow::reload() {
    if (file_.isEmpty()) return;
    // when an editor replaces the file, it is no longer watched
    if (!watcher_.files().contains(file_)) watcher_.addPath(file_);
    composer_->open(file_);
    changed_ = runner_.running() || starts_;
    if (changed_) return;
    loader_.load({request(file_), false, false, "", composer_->unsaved()});
    update_state();
}

void OperatorWindow::pick(size_t body) {
    if (!plan_ || !compose_dock_->isVisible()) return;
    const scene::Body& picked = plan_->scene.bodies[body];
    if (composer_->go_to(picked.place)) {
        composer_->move(picked.name, {});  // reports now if it cannot
    } else {
        composer_->tell(tr("%1 is in %2: open that file to change it.")
                            .arg(QString::fromStdString(picked.name),
                                 QString::fromStdString(picked.place.file)));
    }
}

void OperatorWindow::move_body(const std::string& name, const BodyWay& way, bool shown) {
    if (!composer_->move(name, way)) {
        scene_->show_frame(frame_);  // where it was
    } else if (!shown) {
        scene_->move_picked(way);
    }
}

void OperatorWindow::step_body(const Vec3& step) {
    mark_picked();  // the cursor may have moved since
    move_body(composer_->body(), {step, 0}, false);
}

void OperatorWindow::mark_picked() {
    const bool composes = plan_ && compose_dock_->isVisible() && !runner_.running();
    const int body = composes ? plan_->scene.find(composer_->body()) : -1;
    scene_->set_picked(body < 0 ? std::nullopt : std::optional(static_cast<size_t>(body)));
}

void OperatorWindow::opened(const Opened& opened) {
    auto devices = loader_.take_devices();  // closed again, unless a session starts now
    if (runner_.running()) return;
    plan_ = opened.plan;
    remember(file_);
    frame_ = opened.frame;
    complaint_.clear();
    text_is_wrong_ = false;
    // opened devices may have reported more
    QStringList warnings;
    for (const Problem& warning : plan_->warnings)
        warnings += QString::fromStdString(warning.text());
    composer_->show_problems(warnings);
    if ((!starts_ || rig::is_real(plan_->rig)) && !composer_->changed()) {
        for (const QString& warning : warnings) log(warning, true);
    }
    workspaces_ = opened.workspaces;
    scene_->set_scene(plan_->scene, frame_, workspaces_, opened.turn);
    subjects_.set_scene(plan_->scene, frame_, plan_->rig);
    plots_->set_scene(plan_->scene);
    tuning_->set_knobs(frame::Knobs::of(plan_->settings));
    devices_->set_devices(opened.devices);
    camera_menu_->clear();
    for (const view::Camera& camera : scene_->cameras()) {
        camera_menu_->addAction(QString::fromStdString(camera.name), this,
                                [this, name = camera.name] { scene_->set_camera(name); });
    }
    const QString title = QString::fromStdString(plan_->title);
    session_->set_file(file_);
    setWindowTitle(title + " - Dihaptic");
    for (const QString& line : opened.told) log(line);
    if (starts_) {
        const recording::Participant asked = *std::exchange(starts_, std::nullopt);
        return run(*plan_, opened.participant.value_or(asked), std::move(devices));
    }
    if (!composer_->changed()) log(tr("opened %1: %2").arg(file_, title));
    update_state();
    if (start_when_opened_) start();
}

void OperatorWindow::refused(const QStringList& problems) {
    text_is_wrong_ = composer_->changed();
    if (std::exchange(start_when_opened_, false) && text_is_wrong_) refuse_to_start();
    starts_.reset();
    composer_->show_problems(problems);
    if (!composer_->changed()) {  // the user sees mistakes at their place while typing
        complaint_ = problems.front();
        for (const QString& problem : problems) log(problem, true);
        if (plan_) log(tr("The open file stays as it is."));
    }
    update_state();
    if (changed_) reload();
}

void OperatorWindow::choose_folder() {
    const QString folder = QFileDialog::getExistingDirectory(this, tr("Where sessions go"), out_);
    if (folder.isEmpty()) return;
    out_ = folder;
    log(tr("sessions are stored in %1").arg(folder));
}

}  // namespace dihaptic::gui
