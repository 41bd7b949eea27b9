// The operator's window: its menus, and its remembered settings.
#include "operator_window.h"

#include <QCoreApplication>
#include <QDesktopServices>
#include <QDir>
#include <QDockWidget>
#include <QFileInfo>
#include <QMenuBar>
#include <QMessageBox>
#include <QScreen>
#include <QSettings>
#include <QUrl>

#include "help_page.h"
#include "layers_menu.h"
#include "theme.h"

namespace dihaptic::gui {

void OperatorWindow::make_file_menu() {
    QMenu* file = menuBar()->addMenu(tr("&File"));
    open_action_ =
        file->addAction(tr("&Open ..."), QKeySequence::Open, this, &OperatorWindow::choose_file);
    start_page_action_ = file->addAction(tr("S&tart page"), this, &OperatorWindow::show_start_page);
    recent_menu_ = file->addMenu(tr("Open &recent"));
    connect(recent_menu_, &QMenu::aboutToShow, this, &OperatorWindow::fill_recent);
    edit_action_ = file->addAction(tr("&Edit"), QKeySequence("Ctrl+E"), this, [this] {
        compose_dock_->show();
        composer_->take_focus();
    });
    undo_action_ =
        file->addAction(tr("&Undo"), QKeySequence::Undo, this, [this] { composer_->undo(); });
    redo_action_ =
        file->addAction(tr("Re&do"), QKeySequence::Redo, this, [this] { composer_->redo(); });
    undo_action_->setEnabled(false);
    redo_action_->setEnabled(false);
    save_action_ =
        file->addAction(tr("Sa&ve"), QKeySequence::Save, this, [this] { composer_->save(); });
    save_action_->setEnabled(false);
    file->addAction(tr("Save &as ..."), QKeySequence("Ctrl+Shift+S"), this,
                    &OperatorWindow::save_as);
    file->addAction(tr("Recorded &sessions ..."), QKeySequence("Ctrl+Shift+O"), this,
                    &OperatorWindow::choose_session);
    file->addAction(tr("&Folder of sessions"), this, [this] {
        QDir().mkpath(out_);
        QDesktopServices::openUrl(QUrl::fromLocalFile(QDir(out_).absolutePath()));
    });
    file->addAction(tr("&Where sessions go ..."), this, &OperatorWindow::choose_folder);
    file->addAction(tr("Re&port of the last session"), QKeySequence("Ctrl+R"), this,
                    &OperatorWindow::report);
    file->addSeparator();
    file->addAction(tr("&Quit"), QKeySequence::Quit, this, &QWidget::close);
}

void OperatorWindow::make_session_menu() {
    QMenu* session = menuBar()->addMenu(tr("&Session"));
    const auto add = [&](const QString& name, int key, auto what) {
        QAction* action = session->addAction(name, QKeySequence(key), this, what);
        action->setShortcutContext(Qt::ApplicationShortcut);  // works in the subject's window too
        return action;
    };
    start_action_ = add(tr("&Start"), Qt::Key_F5, &OperatorWindow::start);
    pause_action_ =
        add(tr("&Pause, or continue"), Qt::Key_F6, [this] { pause(!runner_.paused()); });
    stop_action_ = add(tr("S&top"), Qt::Key_F7, &OperatorWindow::stop);
    skip_action_ = add(tr("S&kip the trial"), Qt::Key_F8, &OperatorWindow::skip);
    back_action_ = add(tr("&Hand back to its start"), Qt::Key_F4, [this] {
        if (!mouse_) return;
        mouse_->go_back();
        move_hand(0);
    });
    step_action_ = session->addAction(tr("Do &one tick"), QKeySequence("Ctrl+."), this,
                                      [this] { runner_.step(1); });
    // Application sees this key, whichever widget has the keyboard focus
    force_off_action_ = add(tr("&Force off"), Qt::Key_Escape, &OperatorWindow::force_off);
    session->addSeparator();
    checklist_action_ = session->addAction(tr("Checklist &before the session ..."), this,
                                           [this] { show_checklist(false); });
    calibrate_action_ =
        session->addAction(tr("&Calibrate the rig ..."), this, &OperatorWindow::calibrate);
    register_action_ = session->addAction(tr("Re&gister the display ..."), this, [this] {
        calibrator_->register_display(rig_file(), rig_named_by());
    });
}

void OperatorWindow::make_view_menu() {
    view_menu_ = menuBar()->addMenu(tr("&View"));
    camera_menu_ = view_menu_->addMenu(tr("C&amera"));
    view_menu_->addAction(tr("&Reset the camera"), QKeySequence(Qt::Key_Home), scene_,
                          &SceneWidget::reset_camera);
    follow_action_ = view_menu_->addAction(tr("&Workspace follows camera"));
    follow_action_->setShortcut(QKeySequence(Qt::Key_F9));
    follow_action_->setCheckable(true);
    follow_action_->setChecked(QSettings().value("follow_camera", false).toBool());
    connect(follow_action_, &QAction::toggled, this, [this](bool on) {
        QSettings().setValue("follow_camera", on);
        log(on ? tr("the devices' workspace follows the camera")
               : tr("the devices' workspace turns back to its angle in the rig"));
        turn_workspaces();
    });
    view_menu_->addSeparator();
    add_layers(*view_menu_, *scene_);
    add_layer(*view_menu_, *scene_, tr("Works&paces"), &SceneWidget::Layers::workspaces);
    add_layer(*view_menu_, *scene_, tr("&Lines down to the table"),
              &SceneWidget::Layers::drop_lines);
    view_menu_->addSeparator();
    subject_action_ = view_menu_->addAction(tr("&Subject's window"));
    subject_action_->setCheckable(true);
    connect(subject_action_, &QAction::toggled, this, &OperatorWindow::show_subject_window);
    connect(add_fine_pictures(*view_menu_, *scene_), &QAction::triggered, this,
            [this](bool on) { subjects_.each([on](SceneWidget& scene) { scene.set_fine(on); }); });
    QAction* dark = view_menu_->addAction(tr("&Dark"));
    dark->setCheckable(true);
    dark->setChecked(QSettings().value("dark", false).toBool());
    connect(dark, &QAction::toggled, this, [](bool on) {
        set_dark(on);
        QSettings().setValue("dark", on);
    });
    QMenu* panels = view_menu_->addMenu(tr("Pa&nels"));
    for (QDockWidget* dock : findChildren<QDockWidget*>()) {
        panels->addAction(dock->toggleViewAction());
        // a panel that shares its place with others is behind them
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
        resize(QSize(1400, 900).boundedTo(screen()->availableSize()));
    restoreState(settings.value("docks").toByteArray());
}

void OperatorWindow::show_page_of_docs(const QString& name) {
    const QString why = show_help_page(name);
    if (!why.isEmpty()) log(why, true);
}

void OperatorWindow::fill_recent() {
    recent_menu_->clear();
    for (const QString& file : StartPage::recent_files()) {
        recent_menu_->addAction(file, this, [this, file] {
            if (open_action_->isEnabled()) open(file);
        });
    }
    if (recent_menu_->isEmpty()) recent_menu_->addAction(tr("nothing yet"))->setEnabled(false);
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
