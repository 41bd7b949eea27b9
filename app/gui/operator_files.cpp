// The operator's window: the open file, and opening others.
#include "operator_window.h"

#include <QDir>
#include <QDockWidget>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>
#include <QMessageBox>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "reporter.h"
#include "save_dialog.h"
#include "session_player.h"
#include "sessions_dialog.h"

namespace dihaptic::gui {
namespace {

QString compose_help() {
    return QObject::tr(
        "Click a body, then drag it.   Shift: up and down.   Ctrl: turn.\n"
        "Arrows, Page Up, Page Down: 1 mm; with Shift, 10 mm.");
}

}  // namespace

void OperatorWindow::connect_files() {
    connect(composer_, &Composer::edited, this, &OperatorWindow::reload);
    connect(composer_, &Composer::saved, this, &OperatorWindow::reload);
    connect(composer_, &Composer::told, this, [this](const QString& text) { log(text, true); });
    connect(composer_, &Composer::draft_taken, compose_dock_, &QWidget::show);
    connect(composer_, &Composer::modified, &control_, &SessionControl::set_edited);
    connect(&control_, &SessionControl::judged, composer_, &Composer::show_problems);
    connect(&control_, &SessionControl::file_changed, this, &OperatorWindow::reload);
    connect(composer_, &Composer::cursor_moved, this, &OperatorWindow::mark_picked);
    connect(composer_, &Composer::save_as_wanted, this, &OperatorWindow::save_as);
    connect(composer_, &Composer::step_wanted, this, [this](const QKeyEvent& event) {
        if (const auto step = step_of(event, scene_->camera())) step_body(*step);
    });
    connect(compose_dock_, &QDockWidget::visibilityChanged, this, &OperatorWindow::mark_picked);
    connect(start_page_, &StartPage::chosen, this, &OperatorWindow::open);
    connect(start_page_, &StartPage::open_requested, this, &OperatorWindow::choose_file);
    connect(start_page_, &StartPage::sessions_requested, this, &OperatorWindow::choose_session);
    connect(start_page_, &StartPage::new_study_requested, this,
            [this] { make_new(NewFiles::Kind::study); });
    connect(new_files_, &NewFiles::made, this, [this](const QString& file) {
        remember_folder_of(file);
        open(file);
    });
    connect(start_page_, &StartPage::cannot_draw, this,
            [this](const QString& why) { log(why, true); });
    connect(new_files_, &NewFiles::failed, this, [this](const QString& why) {
        log(why, true);
        QMessageBox::warning(this, tr("New"), why);
    });
    connect(calibrator_, &Calibrator::logged, this, &OperatorWindow::log);
    connect(calibrator_, &Calibrator::stored, this, &OperatorWindow::reload);
}

void OperatorWindow::choose_file() {
    // if loading ends while the dialog is open, no session must start
    control_.forget_start();
    const QString& now = control_.file();
    const QString start = now.isEmpty() ? QString("experiments") : QFileInfo(now).path();
    const QString file = QFileDialog::getOpenFileName(this, tr("Open a scene or an experiment"),
                                                      start, tr("Scenes and experiments (*.yaml)"));
    if (!file.isEmpty()) open(file);
}

/// Offers the folder of the open file or, for a study, the folder that contains its folder, if it
/// is the user's own.
void OperatorWindow::make_new(NewFiles::Kind kind) {
    control_.forget_start();  // no session must start while the dialog is open
    const bool is_study = kind == NewFiles::Kind::study;
    QDir folder(usual_folder());
    if (!control_.file().isEmpty()) {
        QDir now = QFileInfo(control_.file()).absoluteDir();
        if (is_study) now.cdUp();
        if (is_own_folder(now.path())) folder = now;
    }
    new_files_->make(kind, folder.path());
}

void OperatorWindow::save_as() {
    if (control_.file().isEmpty() || !control_.may(SessionControl::Act::open)) return;
    const QFileInfo now(control_.file());
    const QString usual = is_own_folder(now.absolutePath())
                              ? control_.file()
                              : QDir(usual_folder()).filePath(now.fileName());
    const QString file = QFileDialog::getSaveFileName(this, tr("Save as"), usual,
                                                      tr("Scenes and experiments (*.yaml)"));
    if (!file.isEmpty() && composer_->save_as(file)) {
        remember_folder_of(file);
        open(file);
    }
}

void OperatorWindow::choose_session() {
    auto* dialog = new SessionsDialog(control_.out(), this);
    dialog->follow(*reporter_);
    connect(dialog, &SessionsDialog::chosen, this, &OperatorWindow::play_sessions);
    connect(dialog, &SessionsDialog::report_requested, this, &OperatorWindow::report);
    dialog->open();
}

void OperatorWindow::play_sessions(const QStringList& folders) {
    try {
        open_sessions(folders);
    } catch (const Error& e) {
        log(e.what(), true);
    }
}

session::Request OperatorWindow::request() const {
    session::Request request;
    request.file = control_.file().toStdString();
    request.rig = session_->rig().toStdString();
    request.mouse = session_->hand() == SessionPanel::Hand::mouse;
    request.simulate = session_->hand() == SessionPanel::Hand::person;
    request.participant = session_->participant().toStdString();
    // needed to show files that require a participant; a session has its own participant
    if (request.participant.empty()) request.participant = "S01";
    request.set.emplace_back("proxy.changeable=yes");
    return request;
}

void OperatorWindow::show_start_page() {
    if (!control_.may(SessionControl::Act::open)) return;
    if (modes_->mode() != Mode::prepare) modes_->set(Mode::prepare);
    modes_->set_file(false);
    show_shelves();
}

void OperatorWindow::show_shelves() {
    start_page_->fill();
    centre_->setCurrentWidget(start_page_);
}

void OperatorWindow::show_mode(Mode mode) {
    if (mode == Mode::look) return look_at_sessions();
    const bool has_file = !control_.file().isEmpty();
    modes_->set_file(has_file);
    if (!has_file) return show_shelves();
    start_page_->rest();
    centre_->setCurrentWidget(scene_);
}

void OperatorWindow::look_at_sessions() {
    auto* list = new SessionsDialog(control_.out());
    list->embed();
    list->follow(*reporter_);
    connect(list, &SessionsDialog::report_requested, this, &OperatorWindow::report);
    connect(list, &SessionsDialog::chosen, this, &OperatorWindow::play_sessions);
    // opening a session ends the list, as it would end a dialog
    connect(list, &QDialog::finished, this, [this](int result) {
        if (modes_->mode() != Mode::look) return;
        if (result == QDialog::Accepted) return look_at_sessions();
        modes_->set(Mode::prepare);
    });
    connect(modes_, &Modes::changed, list, &QObject::deleteLater);
    centre_->setCurrentIndex(centre_->addWidget(list));
}

bool OperatorWindow::may_leave_text() {
    if (!composer_->changed()) return true;
    const auto answer = QMessageBox::question(
        this, tr("Save?"), tr("%1 has changes that were not saved.").arg(control_.file()),
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

void OperatorWindow::refuse_to_open(const QString& why) {
    log(why, true);
    if (control_.file().isEmpty()) show_start_page();
    auto* box = new QMessageBox(QMessageBox::Warning, tr("Open"), why, QMessageBox::Close, this);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->open();
}

void OperatorWindow::open(const QString& file) {
    if (const QString why = Composer::why_not_to_open(file); !why.isEmpty())
        return refuse_to_open(why);
    if (!may_leave_text()) return;
    composer_->forget();
    start_page_->rest();
    control_.open(file);
    setWindowTitle(QFileInfo(file).fileName() + "[*] - Dihaptic");  // until its title is read
    modes_->set(Mode::prepare);
    modes_->set_file(true);
    centre_->setCurrentWidget(scene_);
    QStringList rigs;
    for (const QFileInfo& rig :
         QDir(QFileInfo(file).dir().filePath("../rigs")).entryInfoList({"*.yaml"}))
        rigs += rig.filePath();
    session_->set_rigs(rigs);
    reload();
}

void OperatorWindow::reload() {
    if (control_.file().isEmpty()) return;
    control_.watch();
    composer_->open(control_.file());
    control_.read(request(), composer_->unsaved());
}

void OperatorWindow::pick(size_t body) {
    if (!control_.plan() || !compose_dock_->isVisible()) return;
    const scene::Body& picked = control_.plan()->scene.bodies[body];
    if (composer_->go_to(picked.place)) {
        composer_->move(picked.name, {});  // reports at once if the body cannot be moved
    } else {
        composer_->tell(tr("%1 is in %2: open that file to change it.")
                            .arg(QString::fromStdString(picked.name),
                                 QString::fromStdString(picked.place.file)));
    }
}

void OperatorWindow::move_body(const std::string& name, const BodyWay& way, bool shown) {
    if (!composer_->move(name, way)) {
        scene_->show_frame(control_.first_frame());  // shows the body where it was
    } else if (!shown) {
        scene_->move_picked(way);
    }
}

void OperatorWindow::show_drag(size_t body, const Pose& X_WB) {
    const auto in_mm = [](double length) { return QString::number(1e3 * length, 'f', 1); };
    const double turn = std::round(angles_xyz(X_WB.R).z() * 1800 / std::numbers::pi) / 10;
    QString text = tr("%1: x %2, y %3, z %4 mm")
                       .arg(QString::fromStdString(control_.plan()->scene.bodies[body].name),
                            in_mm(X_WB.p.x()), in_mm(X_WB.p.y()), in_mm(X_WB.p.z()));
    if (turn != 0)
        text += tr(", turned by %1 degrees about the vertical").arg(QString::number(turn, 'f', 1));
    scene_->set_help(text);
    composer_->tell(text);
}

void OperatorWindow::show_compose_help() {
    const bool running = control_.runner().running();
    if (running && mouse_) return;  // the help for the mouse is shown
    const auto& plan = control_.plan();
    const auto is_here = [this](const scene::Body& body) {
        return body.place.file == control_.file().toStdString();
    };
    const bool composes =
        plan && compose_dock_->isVisible() && std::ranges::any_of(plan->scene.bodies, is_here);
    scene_->set_help(composes ? compose_help() : "");
}

void OperatorWindow::step_body(const Vec3& step) {
    mark_picked();  // the cursor may have moved meanwhile
    move_body(composer_->body(), {step, 0}, false);
}

void OperatorWindow::mark_picked() {
    show_compose_help();
    const auto& plan = control_.plan();
    const bool composes = plan && compose_dock_->isVisible() && !control_.runner().running();
    const int body = composes ? plan->scene.find(composer_->body()) : -1;
    scene_->set_picked(body < 0 ? std::nullopt : std::optional(static_cast<size_t>(body)));
}

void OperatorWindow::show_opened(const Opened& opened) {
    const session::Plan& plan = opened.plan;
    remember(control_.file());
    scene_->set_scene(plan.scene, opened.frame, opened.workspaces, opened.turn);
    participants_.set_scene(plan.scene, opened.frame, plan.rig);
    camera_menu_->clear();
    for (const view::Camera& camera : scene_->cameras()) {
        camera_menu_->addAction(QString::fromStdString(camera.name), this,
                                [this, name = camera.name] { scene_->set_camera(name); });
    }
    setWindowTitle(QString::fromStdString(plan.title) + "[*] - Dihaptic");
}

void OperatorWindow::choose_folder() {
    const QString folder =
        QFileDialog::getExistingDirectory(this, tr("Where sessions go"), control_.out());
    if (!folder.isEmpty()) control_.set_out(folder);
}

}  // namespace dihaptic::gui
