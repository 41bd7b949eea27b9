#include "operator_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QCoreApplication>
#include <QDesktopServices>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QFileInfo>
#include <QScrollArea>
#include <QSettings>
#include <QUrl>
#include <cstdio>
#include <cstring>
#include <utility>

#include "frame/shown_texts.h"
#include "session_progress.h"

namespace dihaptic::gui {
namespace {

constexpr int kPictureTime = 16;  // time between pictures [ms]: sixty a second
constexpr double kLongestStep =
    0.1;  // longest step of squeezing: the grip is known from the last picture [s]

/// The texts that the task shows, one per line.
QString texts_of(const session::Plan& plan, const frame::Frame& frame) {
    QStringList out;
    if (plan.task) {
        for (const std::string& text : frame::shown_texts(frame.task, plan.task->messages))
            out += QString::fromStdString(text);
    }
    return out.join("\n");
}

/// The state of the rig's patch in a frame; nullopt if there is none.
std::optional<view::PatchLook> patch_of(const session::Plan& plan, const frame::Frame& frame) {
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
    timer_.start(kPictureTime);
    since_refresh_.start();
    restore();
    update_state();
}

OperatorWindow::~OperatorWindow() = default;

void OperatorWindow::make_docks() {
    // `name`: for saveState(), in any language; `entry`: of the menu. The panel's title is the same
    // without its mnemonic.
    const auto add = [&](const char* name, const QString& entry, QWidget* widget,
                         Qt::DockWidgetArea area) {
        auto* dock = new QDockWidget(QString(entry).remove('&'));
        dock->setObjectName(name);
        dock->toggleViewAction()->setText(entry);
        dock->setWidget(widget);
        addDockWidget(area, dock);
        return dock;
    };
    add("Session", tr("&Session"), session_, Qt::RightDockWidgetArea);
    // a laptop's screen is too low for all of a panel
    const auto scrolled = [](QWidget* widget) {
        auto* area = new QScrollArea;
        area->setWidget(widget);
        area->setWidgetResizable(true);
        area->setFrameShape(QFrame::NoFrame);
        return area;
    };
    QDockWidget* tuning_dock =
        add("Tuning", tr("&Tuning"), scrolled(tuning_), Qt::RightDockWidgetArea);
    QDockWidget* plots = add("Plots", tr("&Plots"), scrolled(plots_), Qt::RightDockWidgetArea);
    QDockWidget* trials = add("Trials", tr("T&rials"), trials_, Qt::RightDockWidgetArea);
    QDockWidget* seen = add("What the subject sees", tr("&What the subject sees"), mirror_,
                            Qt::RightDockWidgetArea);
    seen->hide();
    tabifyDockWidget(plots, trials);
    tabifyDockWidget(trials, seen);
    plots->raise();
    QDockWidget* devices = add("Devices", tr("&Devices"), devices_, Qt::BottomDockWidgetArea);
    QDockWidget* log = add("Log", tr("&Log"), log_, Qt::BottomDockWidgetArea);
    compose_dock_ = add("File", tr("&File"), composer_, Qt::LeftDockWidgetArea);
    compose_dock_->hide();
    resizeDocks({devices, log}, {148, 148}, Qt::Vertical);
    resizeDocks({tuning_dock, plots}, {236, 240}, Qt::Vertical);  // shows all of the first
    resizeDocks({plots}, {380}, Qt::Horizontal);
    resizeDocks({compose_dock_}, {480}, Qt::Horizontal);
}

void OperatorWindow::connect_scene() {
    connect(&scene_->rating(), &RatingView::clicked, this, &OperatorWindow::click);
    connect(scene_, &SceneWidget::failed, this, [this](const QString& why) { log(why, true); });
    connect(scene_, &SceneWidget::draws_in_software, this,
            [this](const QString& what) { log(what); });
    connect(scene_, &SceneWidget::picked, this, &OperatorWindow::pick);
    connect(scene_, &SceneWidget::dragged, this, [this](size_t body, const BodyWay& way) {
        move_body(plan_->scene.bodies[body].name, way, true);
    });
    connect(scene_, &SceneWidget::stepped, this, &OperatorWindow::step_body);
    connect(scene_, &SceneWidget::hand_moved, this, [this] { move_hand(0); });
    connect(scene_, &SceneWidget::camera_moved, this, &OperatorWindow::turn_workspaces);
    connect(scene_, &SceneWidget::presented, this, [this](qint64 tick) {
        runner_.watch();
        if (subjects_.empty())
            runner_.note_shown(tick);  // in this case the subject looks at this window
    });
}

void OperatorWindow::connect_subjects() {
    const auto mirror = [this] {
        mirror_->follow(subjects_.first(),
                        subjects_.headset() != nullptr
                            ? tr("The pictures in a headset are not shown here.")
                            : tr("The subject has no window of its own: View > Subject's window."));
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
        complaint_ = tr("The headset has stopped showing.");
        update_state();
    });
    connect(&subjects_, &SubjectWindows::shown_to_head, this,
            [this](const headset::Showing& showing) { runner_.note_shown(showing); });
    // pictures in the first window count as seen
    connect(&subjects_, &SubjectWindows::presented, this,
            [this](qint64 tick) { runner_.note_shown(tick); });
}

void OperatorWindow::connect_session() {
    connect(session_, &SessionPanel::skip_requested, this, &OperatorWindow::skip);
    connect(session_, &SessionPanel::open_requested, this, &OperatorWindow::choose_file);
    connect(session_, &SessionPanel::choice_changed, this, [this] {
        starts_.reset();  // the session about to start had another choice
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
            [this](const frame::Knobs& knobs, const QString& what) {
                if (!runner_.running()) return;
                runner_.turn_knobs(knobs);
                log(what);
            });
}

void OperatorWindow::connect_reports() {
    connect(&figures_, &TrialFigures::found, trials_, &TrialsPanel::set_figures);
    connect(&reporter_, &Reporter::failed, this, [this](const QString& why) { log(why, true); });
    connect(&reporter_, &Reporter::written, this, [this](const QString& page) {
        log(tr("report: %1").arg(page));
        QDesktopServices::openUrl(QUrl::fromLocalFile(QFileInfo(page).absoluteFilePath()));
    });
}

void OperatorWindow::report() {
    if (recorded_.isEmpty()) return log(tr("There is no session of this file to report yet."));
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
    log(tr("trial skipped"));
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
    // an object felt on the right must be seen on the right, by the subject too
    if (follow) subjects_.each([&](SceneWidget& scene) { scene.set_camera(scene_->camera()); });
    if (runner_.running()) runner_.turn_workspaces(follow ? view::azimuth(scene_->camera()) : 0);
}

void OperatorWindow::pause(bool paused) {
    if (!runner_.running() || runner_.finishing()) return;
    runner_.set_paused(paused);
    complaint_.clear();
    log(!paused ? tr("continues")
        : runner_.on_virtual_clock()
            ? tr("paused. F6 continues, Ctrl+. does one tick, F7 ends the session.")
            : tr("paused: force is off. F6 continues, F7 ends the session."));
    if (paused) devices_->rest(tr("paused"));
    update_state();
}

void OperatorWindow::force_off() {
    if (runner_.running() && !runner_.paused()) pause(true);
    // a number that is being typed, and is not yet valid, is undone
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

void OperatorWindow::end_unseen() {
    if (std::exchange(lost_, true)) return;
    std::fprintf(stderr, "another program has closed the window%s\n",
                 runner_.running() ? ": the session ends" : "");
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
    figures_.finish();
    recorded_ = end.folder;
    if (!end.folder.isEmpty()) log(tr("recorded in %1").arg(end.folder));
    devices_->rest(tr("at rest"));
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
    if (const QString folder = runner_.take_folder(); !folder.isEmpty() && runner_.plan().task)
        figures_.follow(folder);
    const frame::Frame& frame = runner_.read_frame();
    if (frame.sequence >= 0) {
        if (mouse_) move_hand(h);
        show_frame(frame);
    }
    if (runner_.finishing()) update_state();
}

/// The picture that the person mainly watches.
SceneWidget& OperatorWindow::first_scene() {
    return subjects_.first() == nullptr ? *scene_ : *subjects_.first();
}

void OperatorWindow::show_frame(const frame::Frame& frame) {
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

/// The question that a click can answer now; null: none.
const task::AskSpec* OperatorWindow::asked_by_mouse() {
    if (state() != SessionPanel::State::running || !has_trials()) return nullptr;
    const frame::Frame& frame = runner_.frame();
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

void OperatorWindow::show_progress(const frame::Frame& frame) {
    const SessionProgress now = progress_of(runner_.plan(), frame, runner_.done());
    if (runner_.plan().task) session_->set_trial(now.trial);
    session_->set_progress(now.share, now.text);
}

void OperatorWindow::move_hand(double h) {
    if (!mouse_ || !runner_.running()) return;
    const frame::Frame& frame = runner_.frame();
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
                : runner_.on_virtual_clock() ? tr("Time stands still.   Ctrl+.: one tick.") + "\n"
                                             : tr("Force is off.") + "\n") +
               tr("F6: continue.   F7: end the session.");
    if (loader_.loading()) return tr("Opening %1 ...").arg(file_);
    if (!complaint_.isEmpty()) return complaint_;
    if (!recorded_.isEmpty())
        return tr("Recorded in %1").arg(recorded_) + "\n" +
               tr("Ctrl+R: its report.   F5: start again");
    return plan_ ? tr("Press F5 to start") : tr("Open a scene or an experiment: Ctrl+O");
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
    mark_picked();
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
        // the window closes once the session's files are written
        closing_ = true;
        runner_.end();
        log(tr("ending the session ..."));
        event->ignore();
        return;
    }
    if (ended_ || lost_) {
        leave_text();  // the user cannot be asked
    } else if (!may_leave_text()) {
        return event->ignore();
    }
    QSettings settings;
    settings.setValue("geometry", saveGeometry());
    settings.setValue("docks", saveState());
    subjects_.close();
    event->accept();
    // windows of recorded sessions do not keep the program running
    QMetaObject::invokeMethod(qApp, &QApplication::closeAllWindows, Qt::QueuedConnection);
    if (ended_ || lost_) QCoreApplication::exit(ended_ ? 1 : 0);  // even if a dialog is open
}

}  // namespace dihaptic::gui
