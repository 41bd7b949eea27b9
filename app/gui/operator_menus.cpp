// The operator's window: its menus and saved settings.
#include "operator_window.h"

#include <QApplication>
#include <QDesktopServices>
#include <QDir>
#include <QDockWidget>
#include <QFileInfo>
#include <QMenuBar>
#include <QMessageBox>
#include <QMetaMethod>
#include <QScreen>
#include <QSettings>
#include <QUrl>

#include "help_page.h"
#include "label_fit.h"
#include "layers_menu.h"
#include "reporter.h"
#include "theme.h"

namespace dihaptic::gui {

void OperatorWindow::make_file_menu() {
    QMenu* file = menuBar()->addMenu(tr("&File"));
    using Act = SessionControl::Act;
    add_new_files(*file->addMenu(tr("&New")));
    enable(file->addAction(tr("&Open ..."), QKeySequence::Open, this, &OperatorWindow::choose_file),
           Act::open);
    QMenu* recent = file->addMenu(tr("Open &recent"));
    connect(recent, &QMenu::aboutToShow, this, [this, recent] { fill_recent(*recent); });
    enable(file->addAction(tr("S&tart page"), this, &OperatorWindow::show_start_page), Act::open);
    file->addSeparator();
    QAction* save = file->addAction(tr("Sa&ve"), QKeySequence::Save, composer_, &Composer::save);
    save->setEnabled(false);
    connect(composer_, &Composer::modified, save, &QAction::setEnabled);
    connect(composer_, &Composer::modified, this, &QWidget::setWindowModified);
    QAction* save_as = file->addAction(tr("Save &as ..."), QKeySequence("Ctrl+Shift+S"), this,
                                       &OperatorWindow::save_as);
    connect(&control_, &SessionControl::changed, save_as, [this, save_as] {
        save_as->setEnabled(!control_.file().isEmpty() && control_.may(Act::open));
    });
    file->addSeparator();
    add_recordings(*file);
    file->addSeparator();
    file->addAction(tr("&Quit"), QKeySequence::Quit, this, &QWidget::close);
}

/// Adds the entries that make files.
void OperatorWindow::add_new_files(QMenu& menu) {
    using Kind = NewFiles::Kind;
    const auto add = [&](const QString& name, Kind kind) {
        enable(menu.addAction(name, this, [this, kind] { make_new(kind); }),
               SessionControl::Act::open);
    };
    add(tr("&Scene ..."), Kind::scene);
    add(tr("&Experiment ..."), Kind::experiment);
    add(tr("S&tudy ..."), Kind::study);
}

/// Adds the entries for recorded sessions.
void OperatorWindow::add_recordings(QMenu& menu) {
    menu.addAction(tr("Recorded &sessions ..."), QKeySequence("Ctrl+Shift+O"), this,
                   &OperatorWindow::choose_session);
    reporter_ = new Reporter(this);
    connect(reporter_, &Reporter::told, this, [this](const QString& text) { log(text); });
    connect(reporter_, &Reporter::failed, this, [this](const QString& why) { log(why, true); });
    connect(reporter_, &Reporter::written, this, [this](const QString& page) {
        log(tr("report: %1").arg(page));
        QDesktopServices::openUrl(QUrl::fromLocalFile(QFileInfo(page).absoluteFilePath()));
    });
    menu.addAction(tr("Re&port of the last session"), QKeySequence("Ctrl+R"), this,
                   [this] { report(control_.recorded()); });
    menu.addAction(tr("&Folder of sessions"), this, [this] {
        QDir().mkpath(control_.out());
        QDesktopServices::openUrl(QUrl::fromLocalFile(QDir(control_.out()).absolutePath()));
    });
    menu.addAction(tr("&Where sessions go ..."), this, &OperatorWindow::choose_folder);
}

void OperatorWindow::report(const QString& folder) {
    if (folder.isEmpty()) return log(tr("There is no session of this file to report yet."));
    reporter_->write(folder);
}

void OperatorWindow::make_edit_menu() {
    QMenu* edit = menuBar()->addMenu(tr("&Edit"));
    const auto add = [&](const QString& name, QKeySequence::StandardKey key, auto what,
                         auto possible) {
        QAction* action = edit->addAction(name, key, composer_, what);
        action->setEnabled(false);
        connect(composer_, possible, action, &QAction::setEnabled);
    };
    add(tr("&Undo"), QKeySequence::Undo, &Composer::undo, &Composer::undo_available);
    add(tr("&Redo"), QKeySequence::Redo, &Composer::redo, &Composer::redo_available);
    edit->addSeparator();
    // every field for text has these slots
    const auto add_for_field = [&](const QString& name, QKeySequence::StandardKey key,
                                   const char* slot) {
        edit->addAction(name, key, this, [slot] {
            QWidget* const field = QApplication::focusWidget();
            if (field == nullptr) return;
            const int method = field->metaObject()->indexOfSlot((QByteArray(slot) + "()").data());
            if (method >= 0) field->metaObject()->method(method).invoke(field);
        });
    };
    add_for_field(tr("Cu&t"), QKeySequence::Cut, "cut");
    add_for_field(tr("&Copy"), QKeySequence::Copy, "copy");
    add_for_field(tr("&Paste"), QKeySequence::Paste, "paste");
    add_for_field(tr("Select &all"), QKeySequence::SelectAll, "selectAll");
    edit->addSeparator();
    edit->addAction(tr("&Find ..."), QKeySequence::Find, this, &OperatorWindow::find);
    edit->addAction(tr("Find &next"), QKeySequence("Ctrl+G"), composer_, &Composer::find_next);
    edit->addAction(tr("Find pre&vious"), QKeySequence("Ctrl+Shift+G"), composer_,
                    &Composer::find_previous);
    edit->addSeparator();
    edit->addAction(tr("File's t&ext"), QKeySequence("Ctrl+E"), this,
                    &OperatorWindow::show_or_hide_text);
}

void OperatorWindow::find() {
    if (centre_->currentWidget() == start_page_) return start_page_->find();
    show_text();
    composer_->find();
}

/// Shows the text or, if the user is typing in it, hides it.
void OperatorWindow::show_or_hide_text() {
    if (compose_dock_->isVisible() && composer_->has_focus()) {
        compose_dock_->hide();
        return scene_->setFocus();
    }
    show_text();
    composer_->take_focus();
}

/// Shows the text, for which recorded sessions give way.
void OperatorWindow::show_text() {
    if (modes_->mode() == Mode::look) modes_->set(Mode::prepare);
    compose_dock_->show();
}

void OperatorWindow::enable(QAction* action, SessionControl::Act act) {
    connect(&control_, &SessionControl::changed, action,
            [this, action, act] { action->setEnabled(control_.may(act)); });
}

void OperatorWindow::make_session_menu() {
    using Act = SessionControl::Act;
    QMenu* session = menuBar()->addMenu(tr("&Session"));
    const auto add = [&](const QString& name, int key, Act act, auto* on, auto what) {
        QAction* action = session->addAction(name, QKeySequence(key), on, what);
        action->setShortcutContext(
            Qt::ApplicationShortcut);  // works in the participant's window too
        enable(action, act);
    };
    add(tr("&Start"), Qt::Key_F5, Act::start, this, &OperatorWindow::start);
    add(tr("&Pause, or resume"), Qt::Key_F6, Act::pause, &control_,
        [this] { control_.pause(!control_.runner().paused()); });
    add(tr("&End the session"), Qt::Key_F7, Act::stop, &control_, &SessionControl::stop);
    add(tr("S&kip the trial"), Qt::Key_F8, Act::skip, &control_, &SessionControl::skip);
    add(tr("&Note on the trial"), Qt::Key_F3, Act::pause, this, [this] {
        modes_->set(Mode::run);
        session_->write_note();
    });
    add(tr("&Hand back to its start"), Qt::Key_F4, Act::move, this, [this] {
        if (!mouse_) return;
        mouse_->go_back();
        move_hand(0);
    });
    enable(session->addAction(tr("Do &one tick"), QKeySequence("Ctrl+."), this,
                              [this] { control_.runner().step(1); }),
           Act::step);
    // Application handles this key, whichever widget has the keyboard focus
    add(tr("&Force off"), Qt::Key_Escape, Act::force_off, this, &OperatorWindow::force_off);
    session->addSeparator();
    enable(session->addAction(tr("Checklist &before the session ..."), this,
                              [this] { show_checklist(false); }),
           Act::prepare);
    enable(session->addAction(tr("&Calibrate the rig ..."), this, &OperatorWindow::calibrate),
           Act::calibrate);
    QAction* place = session->addAction(tr("Re&gister the display ..."), this, [this] {
        calibrator_->register_display(rig_file(), rig_named_by());
    });
    connect(&control_, &SessionControl::changed, place, [this, place] {
        place->setEnabled(control_.may(Act::prepare) && !rig_file().isEmpty() &&
                          !control_.plan()->rig.displays.empty());
    });
}

void OperatorWindow::make_view_menu() {
    QMenu* view = menuBar()->addMenu(tr("&View"));
    menuBar()->setCornerWidget(modes_->make_buttons(*view));
    view->addSeparator();
    camera_menu_ = view->addMenu(tr("C&amera"));
    view->addAction(tr("&Reset the camera"), QKeySequence(Qt::Key_Home), scene_,
                    &SceneWidget::reset_camera);
    follow_action_ = view->addAction(tr("&Workspace follows camera"));
    follow_action_->setShortcut(QKeySequence(Qt::Key_F9));
    follow_action_->setCheckable(true);
    follow_action_->setChecked(QSettings().value("follow_camera", false).toBool());
    connect(follow_action_, &QAction::toggled, this, [this](bool on) {
        QSettings().setValue("follow_camera", on);
        log(on ? tr("the devices' workspace follows the camera")
               : tr("the devices' workspace turns back to its angle in the rig"));
        turn_workspaces();
    });
    view->addSeparator();
    add_layers(*view, *scene_);
    add_layer(*view, *scene_, tr("Works&paces"), &SceneWidget::Layers::workspaces);
    add_layer(*view, *scene_, tr("&Lines down to the table"), &SceneWidget::Layers::drop_lines);
    view->addSeparator();
    participant_action_ = view->addAction(tr("Participant'&s window"));
    participant_action_->setCheckable(true);
    connect(participant_action_, &QAction::toggled, this, &OperatorWindow::show_participant_window);
    connect(add_fine_pictures(*view, *scene_), &QAction::triggered, this, [this](bool on) {
        participants_.each([on](SceneWidget& scene) { scene.set_fine(on); });
    });
    QAction* dark = view->addAction(tr("&Dark"));
    dark->setCheckable(true);
    dark->setChecked(QSettings().value("dark", false).toBool());
    connect(dark, &QAction::toggled, this, [](bool on) {
        set_dark(on);
        QSettings().setValue("dark", on);
    });
    tuning_dock_->toggleViewAction()->setShortcut(QKeySequence("Ctrl+T"));
    QMenu* panels = view->addMenu(tr("Pa&nels"));
    for (QDockWidget* dock : findChildren<QDockWidget*>()) {
        panels->addAction(dock->toggleViewAction());
        // a panel that shares its place with others would otherwise stay behind them
        connect(dock->toggleViewAction(), &QAction::triggered, dock, &QWidget::raise);
    }
}

void OperatorWindow::make_help_menu() {
    QMenu* help = menuBar()->addMenu(tr("&Help"));
    const auto page = [&](const QString& text, const QString& name) {
        return help->addAction(text, this, [this, name] { show_page_of_docs(name); });
    };
    page(tr("&Manual"), "index")->setShortcut(QKeySequence::HelpContents);
    page(tr("This &window"), "window");
    page(tr("&Files: scenes, rigs, experiments"), "files");
    page(tr("&Experiments"), "experiments");
    page(tr("What is &recorded"), "quantities");
    page(tr("&Safety"), "safety");
    help->addSeparator();
    help->addAction(tr("&About Dihaptic"), this, [this] {
        auto* about = new QMessageBox(QMessageBox::NoIcon, tr("About Dihaptic"),
                                      QCoreApplication::applicationVersion() + "\n\n" +
                                          tr("A virtual environment for sensorimotor experiments "
                                             "with force-feedback devices."),
                                      QMessageBox::Close, this);
        about->setAttribute(Qt::WA_DeleteOnClose);
        about->open();
    });
}

void OperatorWindow::restore() {
    const QSettings settings;
    if (!restoreGeometry(settings.value("geometry").toByteArray()))
        resize(QSize(1400, 900).boundedTo(room_on(*screen())));
    restoreState(settings.value("docks").toByteArray());
    modes_->restore();
}

void OperatorWindow::show_page_of_docs(const QString& name) {
    const QString why = show_help_page(name);
    if (why.isEmpty()) return;
    auto* box =
        new QMessageBox(QMessageBox::Information, tr("Manual"), why, QMessageBox::Close, this);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->setTextInteractionFlags(Qt::TextSelectableByMouse);  // contains a command to type
    box->open();
}

void OperatorWindow::fill_recent(QMenu& menu) {
    menu.clear();
    for (const QString& file : StartPage::recent_files()) {
        menu.addAction(file, this, [this, file] {
            if (control_.may(SessionControl::Act::open)) open(file);
        });
    }
    if (menu.isEmpty()) menu.addAction(tr("nothing yet"))->setEnabled(false);
}

void OperatorWindow::remember(const QString& file) {
    constexpr int kMost = 8;
    QStringList files = QSettings().value("recent").toStringList();
    const QString path = QFileInfo(file).absoluteFilePath();
    files.removeAll(path);
    files.prepend(path);
    QSettings().setValue("recent", QStringList(files.mid(0, kMost)));
}

}  // namespace dihaptic::gui
