#include "operator_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QCoreApplication>
#include <QDate>
#include <QDateTime>
#include <QDesktopServices>
#include <QDir>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QLocale>
#include <QMenuBar>
#include <QMessageBox>
#include <QPushButton>
#include <QScreen>
#include <QScrollArea>
#include <QSettings>
#include <QShortcut>
#include <QUrl>
#include <cstdio>
#include <cstring>
#include <utility>

#include "layers_menu.h"
#include "rig/calibration_guide.h"
#include "servo/shown_texts.h"
#include "session_player.h"
#include "session_progress.h"
#include "sessions_dialog.h"
#include "theme.h"

namespace dihaptic::gui {
namespace {

constexpr int kRefresh = 16;          // time between pictures [ms]: sixty a second
constexpr double kLongestStep = 0.1;  // of squeezing: the grip is known from the last picture [s]

const QString kMouseHelp =
    "Move the mouse: the hand moves.   Shift + move: toward you and away.\n"
    "Wheel down, or hold Space: squeeze.   Wheel up, or hold V: let go.\n"
    "Drag: turn.   Right drag: look around.   Ctrl + wheel: zoom.\n"
    "H: the hand stays, or moves on.   F4: it goes back to its start.   Escape: force off.";
const QString kFingerHelp =
    "Move the mouse: the finger moves.   Wheel, or Shift + move: toward you and away.\n"
    "Right drag: look around.   Ctrl + wheel: zoom.\n"
    "H: the finger stays, or moves on.   F4: it goes back to its start.   Escape: force off.";

/// A simulated person, unless the operator gives it another name.
const std::string kSimulated = "sim-001";

/// The texts that the task shows, a line each.
QString texts_of(const session::Plan& plan, const servo::Frame& frame) {
    QStringList out;
    if (plan.task) {
        for (const std::string& text : servo::shown_texts(frame.task, plan.task->messages))
            out += QString::fromStdString(text);
    }
    return out.join("\n");
}

QString question_of(const session::Unfinished& session, const std::string& participant) {
    const QDateTime started =
        QDateTime::fromString(QString::fromStdString(session.started), Qt::ISODate).toLocalTime();
    const QString done =
        session.done == 0
            ? QString("not finished")
            : QString("stopped after %1 of %2 trials").arg(session.done).arg(session.trials);
    return QString(
               "%1 began this experiment on %2, and the session was %3. %4\n\nGo on with it in the "
               "same way, or start anew?")
        .arg(QString::fromStdString(participant), QLocale().toString(started, "d MMMM, HH:mm"),
             done, QString::fromStdString(session.moved_by.describe()));
}

/// A person's hand, and what stands in for it at a script's own pace, need real time.
session::Clock clock_of(const session::Plan& plan, double pace) {
    const bool at_own_pace = plan.moved_by.mover == recording::Mover::simulated_person || pace != 1;
    return at_own_pace && !plan.moved_by.person() && !rig::is_real(plan.rig)
               ? session::Clock::virtual_clock
               : session::Clock::real;
}

/// Peak force of the weakest device [N].
double least_peak(const session::Plan& plan) {
    double out = std::numeric_limits<double>::infinity();
    for (const devices::DeviceInfo& device : plan.devices)
        out = std::min(out, plan.settings.safety.largest_force(device.peak_force));
    return out;
}

/// How the rig's patch is in a frame; nullopt: there is none.
std::optional<view::PatchLook> patch_of(const session::Plan& plan, const servo::Frame& frame) {
    if (!plan.rig.patch) return {};
    const bool in_state = plan.task && frame.trial > 0 && frame.phase > 0 && frame.task.outcome < 0;
    const bool white =
        in_state && plan.task->task.states[static_cast<size_t>(frame.phase) - 1].patch;
    return view::PatchLook{*plan.rig.patch, white};
}

}  // namespace

OperatorWindow::OperatorWindow(QString out, double sync, std::atomic<bool>& stop)
    : out_(std::move(out)),
      sync_(sync),
      runner_(stop),
      subjects_(*this),
      calibrator_(new Calibrator(this)),
      centre_(new QStackedWidget),
      start_page_(new StartPage),
      scene_(new SceneWidget),
      session_(new SessionPanel),
      plots_(new PlotsPanel),
      trials_(new TrialsPanel),
      devices_(new DevicePanel),
      tuning_(new TuningPanel),
      composer_(new Composer),
      mirror_(new SubjectMirror),
      log_(new LogView) {
    setWindowTitle("Dihaptic");
    centre_->addWidget(scene_);
    centre_->addWidget(start_page_);
    setCentralWidget(centre_);
    make_docks();
    make_file_menu();
    make_session_menu();
    make_view_menu();
    make_help_menu();
    connect_scene();
    connect_subjects();
    connect_session();
    connect_tuning();
    connect_reports();
    connect_files();
    connect(&timer_, &QTimer::timeout, this, &OperatorWindow::refresh);
    timer_.start(kRefresh);
    since_refresh_.start();
    restore();
    update_state();
}

OperatorWindow::~OperatorWindow() = default;

void OperatorWindow::connect_scene() {
    connect(&scene_->rating(), &RatingView::clicked, this, &OperatorWindow::click);
    connect(scene_, &SceneWidget::failed, this, [this](const QString& why) { log(why, true); });
    connect(scene_, &SceneWidget::draws_in_software, this,
            [this](const QString& what) { log(what); });
    connect(scene_, &SceneWidget::picked, this, [this](size_t body) {
        if (!plan_ || !compose_dock_->isVisible()) return;
        const scene::Body& picked = plan_->scene.bodies[body];
        if (!composer_->go_to(picked.place))
            log(QString("%1 is in %2: open that to change it.")
                    .arg(QString::fromStdString(picked.name),
                         QString::fromStdString(picked.place.file)));
    });
    connect(scene_, &SceneWidget::hand_moved, this, [this] { move_hand(0); });
    connect(scene_, &SceneWidget::camera_moved, this, &OperatorWindow::turn_workspaces);
    connect(scene_, &SceneWidget::presented, this, [this](qint64 tick) {
        runner_.watch();
        if (subjects_.empty()) runner_.note_shown(tick);  // then the subject looks at this window
    });
}

void OperatorWindow::connect_subjects() {
    const auto mirror = [this] {
        mirror_->follow(subjects_.first(),
                        subjects_.headset() != nullptr
                            ? "The pictures in a headset are not shown here."
                            : "The subject has no window of its own: View > Subject's window.");
    };
    mirror();
    connect(&subjects_, &SubjectWindows::changed, this, mirror);
    connect(&subjects_, &SubjectWindows::key_pressed, this, &OperatorWindow::press);
    connect(&subjects_, &SubjectWindows::clicked, this, &OperatorWindow::click);
    connect(&subjects_, &SubjectWindows::closed, this,
            [this] { subject_action_->setChecked(false); });
    connect(&subjects_, &SubjectWindows::told, this, &OperatorWindow::log);
    connect(&subjects_, &SubjectWindows::headset_ended, this, [this] {
        subject_action_->setChecked(false);
        if (!runner_.running() || runner_.paused()) return;
        pause(true);
        complaint_ = "The headset shows nothing more.";
        update_state();
    });
    connect(&subjects_, &SubjectWindows::shown_in_headset, this,
            [this](const headset::Showing& showing) { runner_.note_shown(showing); });
    // pictures of what the first one shows count as seen
    connect(&subjects_, &SubjectWindows::presented, this,
            [this](qint64 tick) { runner_.note_shown(tick); });
}

void OperatorWindow::connect_session() {
    connect(session_, &SessionPanel::skip_requested, this, &OperatorWindow::skip);
    connect(session_, &SessionPanel::open_requested, this, &OperatorWindow::choose_file);
    connect(session_, &SessionPanel::choice_changed, this, [this] {
        starts_.reset();  // the session that was to start had another choice
        reload();
    });
    connect(session_, &SessionPanel::start_requested, this, &OperatorWindow::start);
    connect(session_, &SessionPanel::stop_requested, this, &OperatorWindow::stop);
    connect(session_, &SessionPanel::pause_requested, this, &OperatorWindow::pause);
    connect(session_, &SessionPanel::pace_changed, this, [this](double pace) {
        if (runner_.running() && runner_.on_virtual_clock()) runner_.set_pace(pace);
    });
    connect(&runner_, &SessionRunner::ended, this, &OperatorWindow::session_ended);
    connect(&runner_, &SessionRunner::paused_at_once, this, [this] { pause(true); });
    connect(&runner_, &SessionRunner::warned, this,
            [this](const QString& message) { log(message, true); });
    connect(&runner_, &SessionRunner::finishing_progressed, session_, &SessionPanel::set_finishing);
}

void OperatorWindow::connect_tuning() {
    connect(tuning_, &TuningPanel::turned, this,
            [this](const servo::Knobs& knobs, const QString& what) {
                if (!runner_.running()) return;
                runner_.turn_knobs(knobs);
                log(what);
            });
}

void OperatorWindow::connect_reports() {
    connect(&reporter_, &Reporter::failed, this, [this](const QString& why) { log(why, true); });
    connect(&reporter_, &Reporter::written, this, [this](const QString& page) {
        log("report: " + page);
        QDesktopServices::openUrl(QUrl::fromLocalFile(QFileInfo(page).absoluteFilePath()));
    });
}

void OperatorWindow::connect_files() {
    connect(composer_, &Composer::edited, this, &OperatorWindow::reload);
    connect(composer_, &Composer::saved, this, &OperatorWindow::reload);
    connect(composer_, &Composer::modified, save_action_, &QAction::setEnabled);
    connect(start_page_, &StartPage::chosen, this, &OperatorWindow::open);
    connect(start_page_, &StartPage::open_requested, this, &OperatorWindow::choose_file);
    connect(start_page_, &StartPage::sessions_requested, this, &OperatorWindow::choose_session);
    connect(calibrator_, &Calibrator::logged, this, &OperatorWindow::log);
    connect(calibrator_, &Calibrator::stored, this, &OperatorWindow::reload);
    connect(&loader_, &Loader::opened, this, &OperatorWindow::opened);
    connect(&loader_, &Loader::refused, this, &OperatorWindow::refused);
    reload_.setSingleShot(true);
    connect(&watcher_, &QFileSystemWatcher::fileChanged, this, [this] { reload_.start(300); });
    connect(&reload_, &QTimer::timeout, this, &OperatorWindow::reload);
}

void OperatorWindow::make_docks() {
    const auto add = [&](const QString& title, QWidget* widget, Qt::DockWidgetArea area) {
        auto* dock = new QDockWidget(title);
        dock->setObjectName(title);  // saveState() needs it
        dock->setWidget(widget);
        addDockWidget(area, dock);
        return dock;
    };
    add("Session", session_, Qt::RightDockWidgetArea);
    // a laptop's screen is too low for all of a panel
    const auto scrolled = [](QWidget* widget) {
        auto* area = new QScrollArea;
        area->setWidget(widget);
        area->setWidgetResizable(true);
        area->setFrameShape(QFrame::NoFrame);
        return area;
    };
    QDockWidget* tuning_dock = add("Tuning", scrolled(tuning_), Qt::RightDockWidgetArea);
    QDockWidget* plots = add("Plots", scrolled(plots_), Qt::RightDockWidgetArea);
    QDockWidget* trials = add("Trials", trials_, Qt::RightDockWidgetArea);
    QDockWidget* seen = add("What the subject sees", mirror_, Qt::RightDockWidgetArea);
    seen->hide();
    tabifyDockWidget(plots, trials);
    tabifyDockWidget(trials, seen);
    plots->raise();
    QDockWidget* devices = add("Devices", devices_, Qt::BottomDockWidgetArea);
    QDockWidget* log = add("Log", log_, Qt::BottomDockWidgetArea);
    compose_dock_ = add("File", composer_, Qt::LeftDockWidgetArea);
    compose_dock_->hide();
    resizeDocks({devices, log}, {148, 148}, Qt::Vertical);
    resizeDocks({tuning_dock, plots}, {236, 240}, Qt::Vertical);  // shows all of the first
    resizeDocks({plots}, {380}, Qt::Horizontal);
    resizeDocks({compose_dock_}, {480}, Qt::Horizontal);
}

void OperatorWindow::make_file_menu() {
    QMenu* file = menuBar()->addMenu("&File");
    open_action_ =
        file->addAction("&Open ...", QKeySequence::Open, this, &OperatorWindow::choose_file);
    start_page_action_ = file->addAction("S&tart page", this, &OperatorWindow::show_start_page);
    recent_menu_ = file->addMenu("Open &recent");
    connect(recent_menu_, &QMenu::aboutToShow, this, &OperatorWindow::fill_recent);
    edit_action_ = file->addAction("&Edit", QKeySequence("Ctrl+E"), this, [this] {
        compose_dock_->show();
        composer_->take_focus();
    });
    save_action_ =
        file->addAction("Sa&ve", QKeySequence::Save, this, [this] { composer_->save(); });
    save_action_->setEnabled(false);
    file->addAction("Save &as ...", QKeySequence("Ctrl+Shift+S"), this, &OperatorWindow::save_as);
    file->addAction("Recorded &sessions ...", QKeySequence("Ctrl+Shift+O"), this,
                    &OperatorWindow::choose_session);
    file->addAction("&Folder of sessions", this, [this] {
        QDir().mkpath(out_);
        QDesktopServices::openUrl(QUrl::fromLocalFile(QDir(out_).absolutePath()));
    });
    file->addAction("&Where sessions go ...", this, &OperatorWindow::choose_folder);
    file->addAction("Re&port of the last session", QKeySequence("Ctrl+R"), this,
                    &OperatorWindow::report);
    file->addSeparator();
    file->addAction("&Quit", QKeySequence::Quit, this, &QWidget::close);
}

void OperatorWindow::make_session_menu() {
    QMenu* session = menuBar()->addMenu("&Session");
    const auto add = [&](const QString& name, int key, auto what) {
        QAction* action = session->addAction(name, QKeySequence(key), this, what);
        action->setShortcutContext(Qt::ApplicationShortcut);  // works in the subject's window too
        return action;
    };
    start_action_ = add("&Start", Qt::Key_F5, &OperatorWindow::start);
    pause_action_ = add("&Pause, or go on", Qt::Key_F6, [this] { pause(!runner_.paused()); });
    stop_action_ = add("S&top", Qt::Key_F7, &OperatorWindow::stop);
    skip_action_ = add("S&kip the trial", Qt::Key_F8, &OperatorWindow::skip);
    back_action_ = add("&Hand back to its start", Qt::Key_F4, [this] {
        if (!mouse_) return;
        mouse_->go_back();
        move_hand(0);
    });
    step_action_ = session->addAction("Do &one tick", QKeySequence("Ctrl+."), this,
                                      [this] { runner_.step(1); });
    // Application sees this key, whichever widget has the keyboard focus
    force_off_action_ = add("&Force off", Qt::Key_Escape, &OperatorWindow::force_off);
    session->addSeparator();
    checklist_action_ = session->addAction("Checklist &before the session ...", this,
                                           [this] { show_checklist(false); });
    calibrate_action_ =
        session->addAction("&Calibrate the rig ...", this, &OperatorWindow::calibrate);
    register_action_ = session->addAction("Re&gister the display ...", this,
                                          [this] { calibrator_->register_display(rig_file()); });
}

void OperatorWindow::make_view_menu() {
    view_menu_ = menuBar()->addMenu("&View");
    camera_menu_ = view_menu_->addMenu("C&amera");
    view_menu_->addAction("&Reset the camera", QKeySequence(Qt::Key_Home), scene_,
                          &SceneWidget::reset_camera);
    follow_action_ = view_menu_->addAction("&Workspace follows camera");
    follow_action_->setShortcut(QKeySequence(Qt::Key_F9));
    follow_action_->setCheckable(true);
    follow_action_->setChecked(QSettings().value("follow_camera", false).toBool());
    connect(follow_action_, &QAction::toggled, this, [this](bool on) {
        QSettings().setValue("follow_camera", on);
        log(on ? "the devices' workspace follows the camera"
               : "the devices' workspace turns back to where the rig has it");
        turn_workspaces();
    });
    view_menu_->addSeparator();
    add_layers(*view_menu_, *scene_);
    add_layer(*view_menu_, *scene_, "Works&paces", &SceneWidget::Layers::workspaces);
    add_layer(*view_menu_, *scene_, "&Lines down to the table", &SceneWidget::Layers::drop_lines);
    view_menu_->addSeparator();
    subject_action_ = view_menu_->addAction("&Subject's window");
    subject_action_->setCheckable(true);
    connect(subject_action_, &QAction::toggled, this, &OperatorWindow::show_subject_window);
    connect(add_fine_pictures(*view_menu_, *scene_), &QAction::triggered, this,
            [this](bool on) { subjects_.each([on](SceneWidget& scene) { scene.set_fine(on); }); });
    QAction* dark = view_menu_->addAction("&Dark");
    dark->setCheckable(true);
    dark->setChecked(QSettings().value("dark", false).toBool());
    connect(dark, &QAction::toggled, this, [](bool on) {
        set_dark(on);
        QSettings().setValue("dark", on);
    });
    QMenu* panels = view_menu_->addMenu("Pa&nels");
    for (QDockWidget* dock : findChildren<QDockWidget*>()) {
        panels->addAction(dock->toggleViewAction());
        // one that shares its place with others is shown behind them
        connect(dock->toggleViewAction(), &QAction::triggered, dock, &QWidget::raise);
    }
}

void OperatorWindow::restore() {
    const QSettings settings;
    if (!restoreGeometry(settings.value("geometry").toByteArray()))
        resize(QSize(1400, 900).boundedTo(screen()->availableSize()));
    restoreState(settings.value("docks").toByteArray());
}

void OperatorWindow::choose_file() {
    // loading that ends while the dialog is open must not start a session
    start_when_opened_ = false;
    starts_.reset();
    const QString start = file_.isEmpty() ? QString("experiments") : QFileInfo(file_).path();
    const QString file = QFileDialog::getOpenFileName(this, "Open a scene or an experiment", start,
                                                      "Scenes and experiments (*.yaml)");
    if (!file.isEmpty()) open(file);
}

void OperatorWindow::save_as() {
    if (file_.isEmpty() || !open_action_->isEnabled()) return;
    const QString file =
        QFileDialog::getSaveFileName(this, "Save as", file_, "Scenes and experiments (*.yaml)");
    if (!file.isEmpty() && composer_->save_as(file)) open(file);
}

void OperatorWindow::fill_recent() {
    recent_menu_->clear();
    for (const QString& file : StartPage::recent_files()) {
        recent_menu_->addAction(file, this, [this, file] {
            if (open_action_->isEnabled()) open(file);
        });
    }
    if (recent_menu_->isEmpty()) recent_menu_->addAction("nothing yet")->setEnabled(false);
}

void OperatorWindow::remember(const QString& file) {
    constexpr int kMost = 8;
    QStringList files = QSettings().value("recent").toStringList();
    const QString path = QFileInfo(file).absoluteFilePath();
    files.removeAll(path);
    files.prepend(path);
    QSettings().setValue("recent", QStringList(files.mid(0, kMost)));
}

void OperatorWindow::make_help_menu() {
    QMenu* help = menuBar()->addMenu("&Help");
    const auto page = [&](const QString& name, const QString& file) {
        help->addAction(name, this, [this, file] { show_page_of_docs(file); });
    };
    page("This &window", "window.md");
    page("&Files: scenes, rigs, experiments", "files.md");
    page("&Experiments", "experiments.md");
    page("&What is recorded", "quantities.md");
    page("&Safety", "safety.md");
    help->addSeparator();
    help->addAction("&About Dihaptic", this, [this] {
        auto* about = new QMessageBox(QMessageBox::NoIcon, "About Dihaptic",
                                      QCoreApplication::applicationVersion() +
                                          "\n\nA virtual environment for sensorimotor experiments "
                                          "with force-feedback devices.",
                                      QMessageBox::Close, this);
        about->setAttribute(Qt::WA_DeleteOnClose);
        about->open();
    });
}

void OperatorWindow::show_page_of_docs(const QString& file) {
    // the program is in build/PRESET
    const QDir docs(QCoreApplication::applicationDirPath() + "/../../docs");
    if (!docs.exists(file)) return log("there is no " + docs.filePath(file), true);
    QDesktopServices::openUrl(QUrl::fromLocalFile(QDir::cleanPath(docs.filePath(file))));
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
    // for showing a file that needs a participant; a session has its own
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
        this, "Save?", QString("%1 has changes that were not saved.").arg(file_),
        QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
    return answer == QMessageBox::Discard || (answer == QMessageBox::Save && composer_->save());
}

void OperatorWindow::open(const QString& file) {
    if (!may_leave_text()) return;
    composer_->forget();
    start_page_->rest();
    centre_->setCurrentWidget(scene_);
    file_ = file;
    starts_.reset();
    recorded_.clear();
    if (const QStringList watched = watcher_.files(); !watched.isEmpty())
        watcher_.removePaths(watched);
    watcher_.addPath(file);
    QStringList rigs;
    for (const QFileInfo& rig :
         QDir(QFileInfo(file).dir().filePath("../rigs")).entryInfoList({"*.yaml"}))
        rigs += rig.filePath();
    session_->set_rigs(rigs);
    reload();
}

void OperatorWindow::reload() {
    if (file_.isEmpty()) return;
    // when an editor replaces the file it is watched no longer
    if (!watcher_.files().contains(file_)) watcher_.addPath(file_);
    changed_ = runner_.running() || starts_;
    if (changed_) return;
    composer_->open(file_);
    loader_.load({request(composer_->source()), false, false, ""});
    update_state();
}

void OperatorWindow::opened(const Opened& opened) {
    auto devices = loader_.take_devices();  // closed again, unless a session starts now
    if (runner_.running()) return;
    plan_ = opened.plan;
    remember(file_);
    frame_ = opened.frame;
    complaint_.clear();
    text_is_wrong_ = false;
    // of real devices that have been opened, more may be known than before
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
    tuning_->set_knobs(servo::Knobs::of(plan_->settings));
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
    if (!composer_->changed()) log(QString("opened %1: %2").arg(file_, title));
    update_state();
    if (start_when_opened_) start();
}

void OperatorWindow::refused(const QStringList& problems) {
    text_is_wrong_ = composer_->changed();
    if (std::exchange(start_when_opened_, false) && text_is_wrong_) refuse_to_start();
    starts_.reset();
    composer_->show_problems(problems);
    if (!composer_->changed()) {  // who types sees what is wrong where it is
        complaint_ = problems.front();
        for (const QString& problem : problems) log(problem, true);
        if (plan_) log("What was open stays as it is.");
    }
    update_state();
    if (changed_) reload();
}

void OperatorWindow::refuse_to_start() {
    log("The text has errors: it was not saved, and no session starts.", true);
}

void OperatorWindow::start() {
    composer_->check_now();
    start_when_opened_ = loader_.loading() && !starts_;
    if (!plan_ || runner_.running() || loader_.loading()) return;
    if (text_is_wrong_ && composer_->changed()) return refuse_to_start();
    // what can hurt is looked at before, and what cannot when one likes
    if (rig::is_real(plan_->rig)) {
        show_checklist(true);
    } else {
        start_checked();
    }
}

void OperatorWindow::show_checklist(bool before_start) {
    const std::string today = QDate::currentDate().toString(Qt::ISODate).toStdString();
    auto* list =
        new Checklist(session::readiness(*plan_, out_.toStdString(), today), before_start, this);
    connect(list, &Checklist::chosen, this, &OperatorWindow::remedy);
    if (before_start) connect(list, &QDialog::accepted, this, &OperatorWindow::start_checked);
    list->open();
}

void OperatorWindow::remedy(session::Remedy remedy) {
    switch (remedy) {
        case session::Remedy::calibrate:
            return calibrate();
        case session::Remedy::register_display:
            return calibrator_->register_display(rig_file());
        case session::Remedy::choose_folder:
            return choose_folder();
        case session::Remedy::allow_real_time:
            return show_page_of_docs("safety.md");
        case session::Remedy::none:
            return;
    }
}

void OperatorWindow::choose_folder() {
    const QString folder = QFileDialog::getExistingDirectory(this, "Where sessions go", out_);
    if (folder.isEmpty()) return;
    out_ = folder;
    log("sessions go to " + folder);
}

void OperatorWindow::start_checked() {
    if (!plan_ || runner_.running() || loader_.loading()) return;
    if (session_->hand() == SessionPanel::Hand::person) {
        const QString id = session_->participant();
        begin({id.isEmpty() ? kSimulated : id.toStdString(), "", "", ""});
    } else if (plan_->task) {
        start_trials();
    } else {
        begin({session_->participant().toStdString(), "", "", ""});
    }
}

void OperatorWindow::start_trials() {
    const std::string id = session_->participant().toStdString();
    if (id != participant_.id) participant_ = {id, "", "", ""};
    auto* dialog = new ParticipantDialog(participant_, task::needs_number(plan_->task->task), this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QDialog::accepted, this, [this, dialog] {
        participant_ = dialog->participant();
        session_->set_participant(QString::fromStdString(participant_.id));
        begin_or_go_on(participant_);
    });
    dialog->open();
}

void OperatorWindow::begin_or_go_on(const recording::Participant& participant) {
    if (!plan_ || runner_.running()) return;
    if (participant.id.empty()) return begin(participant);
    const auto sessions =
        session::find_unfinished(out_.toStdString(), plan_->title, participant.id);
    if (sessions.empty()) return begin(participant);
    auto* box = new QMessageBox(this);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->setWindowTitle("Go on?");
    box->setText(question_of(sessions.front(), participant.id));
    QPushButton* go_on = box->addButton("&Go on", QMessageBox::AcceptRole);
    QPushButton* anew = box->addButton("Start &anew", QMessageBox::DestructiveRole);
    box->addButton(QMessageBox::Cancel);
    box->setDefaultButton(go_on);
    connect(box, &QMessageBox::buttonClicked, this,
            [=, this, folder = sessions.front().folder](QAbstractButton* pressed) {
                if (pressed == go_on) begin(participant, folder);
                if (pressed == anew) begin(participant);
            });
    box->open();
}

void OperatorWindow::begin(const recording::Participant& participant, const std::string& resumes) {
    if (!plan_ || runner_.running() || loader_.loading()) return;
    if (resumes.empty() && !composer_->save()) return;
    session::Request asked = request(file_);
    asked.participant = participant.id;
    starts_ = participant;
    loader_.load({asked, true, session_->hand() == SessionPanel::Hand::person, resumes});
    update_state();
}

void OperatorWindow::run(const session::Plan& made, const recording::Participant& participant,
                         std::unique_ptr<devices::DeviceGroup> devices) {
    session::RunOptions options;
    options.out = out_.toStdString();
    options.sync = sync_;
    options.command = "dihaptic gui " + file_.toStdString();
    options.participant = participant;
    const std::vector<std::string> fingers = scene::finger_names(made.scene);
    if (rig::can_check_together(made.rig, fingers)) {
        options.check =
            calibrator_->together_check(made.rig, fingers, [this] { return runner_.ending(); });
    }
    changed_ = changed_ || !made.resumes.empty();  // what is shown is the session's, not the file's
    options.clock = clock_of(made, session_->pace());
    start_page_->rest();
    centre_->setCurrentWidget(scene_);
    runner_.start(made, options, session_->pace(), std::move(devices),
                  made.rig.headset ? HeadsetView::frames_from(frame_) : nullptr);
    const session::Plan& plan = runner_.plan();
    follow_in_headset();
    trials_->set_plan(plan.task);
    if (plan.mouse) {
        mouse_.emplace(plan.mouse->goal(), MouseHand::grip_of(least_peak(plan)));
        const bool squeezes = plan.scene.fingers.size() > 1;
        scene_->set_hand(&*mouse_, squeezes);
        scene_->set_help(squeezes ? kMouseHelp : kFingerHelp);
    }
    turn_workspaces();
    scene_->setFocus();
    log("started: " + QString::fromStdString(plan.title));
    if (session_->hand() == SessionPanel::Hand::person && !plan.task)
        log("Simulated people do trials, and this file has none: its script moves the hand.");
    update_state();
}

QString OperatorWindow::rig_file() const {
    QString rig = session_->rig();
    if (rig.isEmpty() && plan_) rig = QString::fromStdString(plan_->rig.place.file);
    return rig.isEmpty() ? "" : QDir::cleanPath(rig);
}

void OperatorWindow::calibrate() {
    if (runner_.running() || loader_.loading()) return;
    const QString rig = rig_file();
    if (rig.isEmpty()) return log("There is no rig file to calibrate: choose a rig.", true);
    calibrator_->calibrate(rig);
}

void OperatorWindow::report() {
    if (recorded_.isEmpty()) return log("There is no session of this file yet to report.");
    reporter_.write(recorded_);
}

void OperatorWindow::stop() {
    start_when_opened_ = false;
    starts_.reset();
    if (runner_.running()) runner_.end();
    if (loader_.loading()) loader_.cancel();
}

void OperatorWindow::skip() {
    if (!runner_.running() || !runner_.plan().task || runner_.paused()) return;
    runner_.skip();
    log("trial skipped");
}

void OperatorWindow::click(double share) {
    if (runner_.running() && runner_.plan().task) runner_.click(share);
}

void OperatorWindow::press(char key) {
    if (key != 0 && runner_.running() && runner_.plan().task) runner_.press(key);
}

void OperatorWindow::keyPressEvent(QKeyEvent* event) {
    press(task_key(*event));
}

void OperatorWindow::turn_workspaces() {
    const bool follow = follow_action_->isChecked();
    // what is felt on the right has to be seen on the right, by the subject too
    if (follow) subjects_.each([&](SceneWidget& scene) { scene.set_camera(scene_->camera()); });
    if (runner_.running()) runner_.turn_workspaces(follow ? view::azimuth(scene_->camera()) : 0);
}

void OperatorWindow::pause(bool paused) {
    if (!runner_.running() || runner_.finishing()) return;
    runner_.set_paused(paused);
    complaint_.clear();
    log(!paused ? "goes on"
        : runner_.on_virtual_clock()
            ? "paused. F6 goes on, Ctrl+. does one tick, F7 ends the session."
            : "paused: force is off. F6 goes on, F7 ends the session.");
    if (paused) devices_->rest("paused");
    update_state();
}

void OperatorWindow::force_off() {
    if (runner_.running() && !runner_.paused()) pause(true);
    // a number that is being typed, and does not count yet, is taken back
    if (auto* const number = qobject_cast<QDoubleSpinBox*>(QApplication::focusWidget()))
        number->setValue(number->value());
}

void OperatorWindow::end(int signal) {
    std::fprintf(
        stderr, "%s: %s\n", strsignal(signal),
        runner_.running() || cut_ ? "force is off, and the session ends" : "the window closes");
    ended_ = true;
    close();
}

void OperatorWindow::session_ended(const SessionEnd& end) {
    cut_ = runner_.stopped();
    calibrator_->end_check();
    mouse_.reset();
    scene_->set_hand(nullptr, false);
    scene_->set_help("");
    said_.clear();
    page_ = -1;
    complaint_.clear();
    session_->set_trial("");
    for (const QString& message : end.messages) log(message, !end.good);
    recorded_ = end.folder;
    if (!end.folder.isEmpty()) log("recorded in " + end.folder);
    devices_->rest("at rest");
    if (plan_ && plan_->rig.patch) first_scene().set_patch(view::PatchLook{*plan_->rig.patch});
    update_state();
    if (closing_) {
        close();
    } else if (changed_) {
        reload();
    }
}

void OperatorWindow::refresh() {
    const double h = static_cast<double>(since_refresh_.restart()) * 1e-3;
    if (!runner_.running()) return;
    if (const QString told = runner_.take_told(); !told.isEmpty()) {
        complaint_ = told;
        log(told, true);
        update_state();
    }
    while (const auto sample = runner_.take_sample()) plots_->add(*sample);
    while (const auto end = runner_.take_trial_end()) trials_->add(*end);
    const servo::Frame& frame = runner_.read_frame();
    if (frame.sequence >= 0) {
        if (mouse_) move_hand(h);
        show_frame(frame);
    }
    if (runner_.finishing()) update_state();
}

/// What the person looks at, first of all.
SceneWidget& OperatorWindow::first_scene() {
    return subjects_.first() == nullptr ? *scene_ : *subjects_.first();
}

void OperatorWindow::show_frame(const servo::Frame& frame) {
    first_scene().set_patch(patch_of(runner_.plan(), frame));
    scene_->show_frame(frame);
    subjects_.each([&](SceneWidget& scene) { scene.show_frame(frame); });
    show_question();
    devices_->show_frame(frame);
    if (runner_.finishing()) return;
    const QString said = texts_of(runner_.plan(), frame);
    if (said != said_ || page_ != frame.task.page) {
        said_ = said;
        page_ = frame.task.page;
        update_state();
    }
    show_progress(frame);
}

/// The question that a click may answer now; null: there is none.
const task::AskSpec* OperatorWindow::asked_by_mouse() {
    if (state() != SessionPanel::State::running || !has_trials()) return nullptr;
    const servo::Frame& frame = runner_.frame();
    if (frame.trial < 1 || frame.phase < 1 || frame.task.outcome >= 0) return nullptr;
    const auto& ask = runner_.plan().task->task.states[static_cast<size_t>(frame.phase) - 1].ask;
    return ask && ask->by == task::AnswerBy::mouse ? &*ask : nullptr;
}

void OperatorWindow::show_question() {
    const task::AskSpec* question = asked_by_mouse();
    scene_->rating().set_question(question);
    subjects_.each([&](SceneWidget& scene) { scene.rating().set_question(question); });
}

bool OperatorWindow::has_trials() const {
    return runner_.running() ? runner_.plan().task != nullptr : plan_ && plan_->task;
}

void OperatorWindow::show_progress(const servo::Frame& frame) {
    const SessionProgress now = progress_of(runner_.plan(), frame, runner_.done());
    if (runner_.plan().task) session_->set_trial(now.trial);
    session_->set_progress(now.share, now.text);
}

void OperatorWindow::move_hand(double h) {
    if (!mouse_ || !runner_.running()) return;
    const servo::Frame& frame = runner_.frame();
    if (frame.sequence < 0) return;
    mouse_->set_grip(frame.grip_force);
    mouse_->squeeze(scene_->keys(), std::min(h, kLongestStep));
    runner_.plan().mouse->follow(mouse_->goal(), seconds(frame.time));
}

void OperatorWindow::show_subject_window(bool shown) {
    subjects_.close();
    if (!shown) return;
    subjects_.open(plan_ ? plan_->rig : rig::Rig{});
    const bool has_frame = runner_.running() && runner_.frame().sequence >= 0;
    if (plan_) subjects_.set_scene(plan_->scene, has_frame ? runner_.frame() : frame_, plan_->rig);
    follow_in_headset();
    turn_workspaces();
    update_state();
}

/// Lets the headset, if there is one, read the running session's frames.
void OperatorWindow::follow_in_headset() {
    if (HeadsetView* const headset = subjects_.headset(); headset && runner_.running())
        headset->follow(runner_.plan().scene, runner_.second());
}

SessionPanel::State OperatorWindow::state() const {
    using State = SessionPanel::State;
    if (runner_.finishing()) return State::finishing;
    if (runner_.running()) return runner_.paused() ? State::paused : State::running;
    if (loader_.loading()) return State::opening;
    return plan_ ? State::ready : State::nothing;
}

QString OperatorWindow::banner() const {
    if (runner_.running() && !runner_.paused()) return message();
    if (runner_.running())
        return complaint_ +
               (!complaint_.isEmpty()        ? "\n"
                : runner_.on_virtual_clock() ? "Time stands still.   Ctrl+.: one tick.\n"
                                             : "Force is off.\n") +
               "F6: go on.   F7: end the session.";
    if (loader_.loading()) return "Opening " + file_ + " ...";
    if (!complaint_.isEmpty()) return complaint_;
    if (!recorded_.isEmpty())
        return "Recorded in " + recorded_ + "\nCtrl+R: its report.   F5: start again";
    return plan_ ? "Press F5 to start" : "Open a scene or an experiment: Ctrl+O";
}

QString OperatorWindow::message() const {
    return runner_.running() && page_ < 0 ? said_ : "";
}

QString OperatorWindow::page_text() const {
    return runner_.running() && page_ >= 0 ? said_ : "";
}

QString OperatorWindow::page_picture() const {
    if (!runner_.running() || page_ < 0) return "";
    const task::TaskPlan::Page& page = runner_.plan().task->pages[static_cast<size_t>(page_)];
    return QString::fromStdString(page.spec.picture);
}

void OperatorWindow::update_state() {
    using State = SessionPanel::State;
    const State now = state();
    const bool idle = now == State::nothing || now == State::ready || now == State::opening;
    const bool runs = now == State::running || now == State::paused;
    open_action_->setEnabled(idle);
    start_page_action_->setEnabled(idle);
    start_action_->setEnabled(now == State::ready || now == State::opening);
    pause_action_->setEnabled(runs);
    stop_action_->setEnabled(runs || now == State::opening);
    back_action_->setEnabled(now == State::running && mouse_);
    step_action_->setEnabled(now == State::paused && runner_.on_virtual_clock());
    skip_action_->setEnabled(now == State::running && has_trials());
    force_off_action_->setEnabled(now == State::running);
    checklist_action_->setEnabled(now == State::ready);
    calibrate_action_->setEnabled(now == State::nothing || now == State::ready);
    register_action_->setEnabled(now == State::ready && !rig_file().isEmpty() &&
                                 !plan_->rig.displays.empty());
    session_->set_state(now, has_trials());
    tuning_->setEnabled(plan_.has_value());
    scene_->set_banner(banner());
    scene_->set_page(page_text(), page_picture());
    show_question();
    const auto show_words = [this](auto& to) {
        to.set_banner(message());
        to.set_page(page_text(), page_picture());
    };
    subjects_.each(show_words);
    if (HeadsetView* const headset = subjects_.headset()) show_words(*headset);
}

void OperatorWindow::log(const QString& text, bool problem) {
    log_->add(text, problem);
}

void OperatorWindow::closeEvent(QCloseEvent* event) {
    if (runner_.running()) {
        // the window closes when the session's files are written
        closing_ = true;
        runner_.end();
        log("ending the session ...");
        event->ignore();
        return;
    }
    if (!ended_ && !may_leave_text()) return event->ignore();
    QSettings settings;
    settings.setValue("geometry", saveGeometry());
    settings.setValue("docks", saveState());
    subjects_.close();
    event->accept();
    // sessions that are looked at do not keep the program
    QMetaObject::invokeMethod(qApp, &QApplication::closeAllWindows, Qt::QueuedConnection);
    if (ended_) QCoreApplication::exit(1);  // even if a dialog is open
}

}  // namespace dihaptic::gui
