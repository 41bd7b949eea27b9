#include "operator_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QCoreApplication>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QScrollArea>
#include <QSettings>
#include <QTimer>
#include <cstdio>
#include <cstring>
#include <utility>

#include "device_panel.h"
#include "participant_mirror.h"
#include "plots_panel.h"
#include "session_sign.h"
#include "trials_panel.h"
#include "tuning_panel.h"

namespace dihaptic::gui {
namespace {

constexpr int kPictureTime = 16;  // time between pictures [ms]: 60 per second
constexpr double kLongestStep =
    0.1;  // longest step of squeezing: the grip is known from the last picture [s]

/// The state of the rig's patch in a frame; nullopt if the rig has no patch.
std::optional<view::PatchLook> patch_of(const session::Plan& plan, const frame::Frame& frame) {
    if (!plan.rig.patch) return {};
    const bool in_state = plan.task && frame.trial > 0 && frame.phase > 0 && frame.task.outcome < 0;
    const bool white =
        in_state && plan.task->task.states[static_cast<size_t>(frame.phase) - 1].patch;
    return view::PatchLook{*plan.rig.patch, white};
}

}  // namespace

OperatorWindow::OperatorWindow(QString out, double sync, std::atomic<bool>& stop)
    : control_(std::move(out), sync, stop),
      participants_(*this),
      calibrator_(new Calibrator(this)),
      modes_(new Modes(this)),
      new_files_(new NewFiles(this)),
      centre_(new QStackedWidget),
      start_page_(new StartPage),
      scene_(new SceneWidget),
      session_(new SessionPanel(control_)),
      composer_(new Composer),
      log_(new LogView) {
    setWindowTitle("Dihaptic[*]");
    centre_->addWidget(scene_);
    centre_->addWidget(start_page_);
    setCentralWidget(centre_);
    make_docks();
    make_file_menu();
    make_edit_menu();
    make_session_menu();
    make_view_menu();
    make_help_menu();
    connect_scene();
    connect_participants();
    connect_session();
    connect_files();
    auto* pictures = new QTimer(this);
    connect(pictures, &QTimer::timeout, this, &OperatorWindow::refresh);
    pictures->start(kPictureTime);
    since_refresh_.start();
    restore();
    Q_EMIT control_.changed();
}

OperatorWindow::~OperatorWindow() = default;

/// Connects the panels that only display what the session control reports.
void OperatorWindow::connect_panels(PlotsPanel* plots, TrialsPanel* trials, DevicePanel* devices,
                                    TuningPanel* tuning) {
    connect(&control_, &SessionControl::opened, this, [=](const Opened& opened) {
        plots->set_plan(opened.plan);
        devices->set_devices(opened.devices);
        tuning->set_knobs(frame::Knobs::of(opened.plan.settings));
    });
    connect(&control_, &SessionControl::started, trials,
            [trials](const session::Plan& plan) { trials->set_plan(plan.task); });
    connect(&control_, &SessionControl::sampled, plots, &PlotsPanel::add);
    connect(&control_, &SessionControl::framed, plots, &PlotsPanel::show_frame);
    connect(trials, &TrialsPanel::charted, plots, &PlotsPanel::set_trials);
    connect(&control_, &SessionControl::trial_ended, trials, &TrialsPanel::add);
    connect(&control_, &SessionControl::measured, trials, &TrialsPanel::set_figures);
    connect(&control_, &SessionControl::framed, devices,
            [this, devices](const frame::Frame& frame) {
                // in a pause, the devices have nothing to say but that
                if (control_.state() != SessionControl::State::paused) devices->show_frame(frame);
            });
    connect(&control_, &SessionControl::rested, devices, &DevicePanel::rest);
    connect(&control_, &SessionControl::changed, tuning,
            [this, tuning] { tuning->setEnabled(control_.plan().has_value()); });
    connect(tuning, &TuningPanel::turned, &control_, &SessionControl::turn_knobs);
}

void OperatorWindow::make_docks() {
    auto* plots_panel = new PlotsPanel;
    auto* trials_panel = new TrialsPanel;
    auto* device_panel = new DevicePanel;
    auto* tuning_panel = new TuningPanel;
    auto* mirror = new ParticipantMirror;
    auto* checks_view = new ChecksView;
    connect_panels(plots_panel, trials_panel, device_panel, tuning_panel);
    connect_checks(checks_view);
    connect_mirror(mirror);
    // `name`: identifies the panel in saveState(), in any language; `entry`: text of its menu
    // entry, which is also the panel's title, without the mnemonic.
    const auto add = [&](const char* name, const QString& entry, QWidget* widget,
                         Qt::DockWidgetArea area) {
        auto* dock = new QDockWidget(QString(entry).remove('&'));
        dock->setObjectName(name);
        dock->toggleViewAction()->setText(entry);
        dock->setWidget(widget);
        addDockWidget(area, dock);
        return dock;
    };
    // the screen of a laptop is not high enough for a whole panel
    const auto scrolled = [](QWidget* widget) {
        auto* area = new QScrollArea;
        area->setWidget(widget);
        area->setWidgetResizable(true);
        area->setFrameShape(QFrame::NoFrame);
        return area;
    };
    const auto right = Qt::RightDockWidgetArea, bottom = Qt::BottomDockWidgetArea;
    const std::set<Mode> working{Mode::prepare, Mode::run};
    modes_->add(add("Session", tr("&Session"), session_, right), working);
    QDockWidget* checks = add("Checks", tr("&Checks"), scrolled(checks_view), right);
    modes_->add(checks, {Mode::prepare});
    tuning_dock_ = add("Tuning", tr("&Tuning"), scrolled(tuning_panel), right);
    modes_->add_drawer(tuning_dock_);
    QDockWidget* plots = add("Plots", tr("&Plots"), scrolled(plots_panel), right);
    modes_->add(plots, {Mode::run});
    QDockWidget* trials = add("Trials", tr("T&rials"), trials_panel, right);
    modes_->add(trials, {Mode::run});
    QDockWidget* seen =
        add("What the participant sees", tr("&What the participant sees"), mirror, right);
    modes_->add_drawer(seen);
    QDockWidget* devices = add("Devices", tr("&Devices"), device_panel, bottom);
    QDockWidget* log = add("Log", tr("&Log"), log_, bottom);
    for (QDockWidget* dock : {devices, log}) modes_->add(dock, working);
    compose_dock_ = add("File", tr("&File"), composer_, Qt::LeftDockWidgetArea);
    modes_->add_drawer(compose_dock_);
    setCorner(Qt::BottomRightCorner, right);  // the plots have the whole height
    tabifyDockWidget(plots, trials);
    tabifyDockWidget(trials, seen);
    plots->raise();
    resizeDocks({devices, log}, {148, 148}, Qt::Vertical);
    resizeDocks({devices, log}, {430, 530}, Qt::Horizontal);
    resizeDocks({plots}, {380}, Qt::Horizontal);
    resizeDocks({compose_dock_}, {480}, Qt::Horizontal);
}

/// Keeps the panel of checks up to date, in which nothing is measured that takes long.
void OperatorWindow::connect_checks(ChecksView* checks) {
    connect(checks, &ChecksView::chosen, this, &OperatorWindow::remedy);
    const auto look = [this, checks] {
        if (control_.plan()) checks->set(findings());
    };
    connect(&control_, &SessionControl::opened, checks, look);
    connect(&control_, &SessionControl::ended, checks, look);
}

void OperatorWindow::connect_scene() {
    connect(&scene_->questions(), &QuestionsView::clicked, &control_, &SessionControl::click);
    connect(scene_, &SceneWidget::failed, this, [this](const QString& why) { log(why, true); });
    connect(scene_, &SceneWidget::draws_in_software, this,
            [this](const QString& what) { log(what); });
    connect(scene_, &SceneWidget::picked, this, &OperatorWindow::pick);
    connect(scene_, &SceneWidget::dragged, this, [this](size_t body, const BodyWay& way) {
        move_body(control_.plan()->scene.bodies[body].name, way, true);
    });
    connect(scene_, &SceneWidget::dragging, this, &OperatorWindow::show_drag);
    connect(scene_, &SceneWidget::stepped, this, &OperatorWindow::step_body);
    connect(scene_, &SceneWidget::hand_moved, this, [this] { move_hand(0); });
    connect(scene_, &SceneWidget::camera_moved, this, &OperatorWindow::turn_workspaces);
    connect(scene_, &SceneWidget::presented, this, [this](qint64 tick) {
        control_.runner().watch();
        if (participants_.empty())
            control_.runner().note_shown(
                tick);  // in this case the participant looks at this window
    });
}

void OperatorWindow::connect_mirror(ParticipantMirror* mirror) {
    const auto follow = [this, mirror] {
        mirror->follow(
            participants_.first(),
            participants_.headset() != nullptr
                ? tr("The pictures in a headset are not shown here.")
                : tr("The participant has no window of their own: View > Participant's window."));
    };
    follow();
    connect(&participants_, &ParticipantWindows::changed, mirror, follow);
}

void OperatorWindow::connect_participants() {
    connect(&participants_, &ParticipantWindows::key_pressed, &control_, &SessionControl::press);
    connect(&participants_, &ParticipantWindows::clicked, &control_, &SessionControl::click);
    connect(&participants_, &ParticipantWindows::closed, this,
            [this] { participant_action_->setChecked(false); });
    connect(&participants_, &ParticipantWindows::told, this, &OperatorWindow::log);
    connect(&participants_, &ParticipantWindows::headset_ended, this, [this] {
        participant_action_->setChecked(false);
        control_.take_force_away(tr("The headset has stopped showing."));
    });
    connect(&participants_, &ParticipantWindows::shown_to_head, this,
            [this](const headset::Showing& showing) { control_.runner().note_shown(showing); });
    // the participant is assumed to see the pictures in the first window
    connect(&participants_, &ParticipantWindows::presented, this,
            [this](qint64 tick) { control_.runner().note_shown(tick); });
}

void OperatorWindow::connect_session() {
    connect(session_, &SessionPanel::open_requested, this, &OperatorWindow::choose_file);
    connect(session_, &SessionPanel::choice_changed, this, [this] {
        control_.drop_start();  // the session was prepared with the previous choice
        reload();
    });
    connect(session_, &SessionPanel::start_requested, this, &OperatorWindow::start);
    connect(session_, &SessionPanel::report_requested, this,
            [this] { report(control_.recorded()); });
    connect(session_, &SessionPanel::note_written, scene_, [this] { scene_->setFocus(); });
    connect(&control_, &SessionControl::logged, this, &OperatorWindow::log);
    connect(&control_, &SessionControl::opened, this, &OperatorWindow::show_opened);
    connect(&control_, &SessionControl::start_due, this, &OperatorWindow::start);
    connect(&control_, &SessionControl::prepared, this, &OperatorWindow::prepare);
    connect(&control_, &SessionControl::started, this, &OperatorWindow::show_start);
    connect(&control_, &SessionControl::framed, this, &OperatorWindow::show_frame);
    connect(&control_, &SessionControl::changed, this, &OperatorWindow::show_state);
    connect(&control_, &SessionControl::ended, this, &OperatorWindow::show_end);
    connect(modes_, &Modes::changed, this, &OperatorWindow::show_mode);
}

void OperatorWindow::keyPressEvent(QKeyEvent* event) {
    control_.press(task_key(*event));
}

void OperatorWindow::turn_workspaces() {
    const bool follow = follow_action_->isChecked();
    // an object felt on the right must be seen on the right by the participant, too
    if (follow) participants_.each([&](SceneWidget& scene) { scene.set_camera(scene_->camera()); });
    if (control_.runner().running())
        control_.runner().turn_workspaces(follow ? view::azimuth(scene_->camera()) : 0);
}

void OperatorWindow::force_off() {
    control_.take_force_away();
    // a number that is still being typed and is not yet valid is reset
    if (auto* const number = qobject_cast<QDoubleSpinBox*>(QApplication::focusWidget()))
        number->setValue(number->value());
}

void OperatorWindow::end(int signal) {
    const bool in_session = control_.runner().running() || control_.cut();
    std::fprintf(stderr, "%s: %s\n", strsignal(signal),
                 in_session ? "force is off, and the session ends" : "the window closes");
    closing_ = Closing::by_signal;
    close();
}

void OperatorWindow::end_unseen() {
    if (closing_ == Closing::by_signal || closing_ == Closing::unseen) return;
    closing_ = Closing::unseen;
    std::fprintf(stderr, "another program has closed the window%s\n",
                 control_.runner().running() ? ": the session ends" : "");
    close();
}

void OperatorWindow::show_end() {
    calibrator_->end_check();
    mouse_.reset();
    scene_->set_hand(nullptr, false);
    if (const auto& plan = control_.plan(); plan && plan->rig.patch)
        first_scene().set_patch(view::PatchLook{*plan->rig.patch});
    if (closing_ != Closing::no) {
        close();
    } else if (control_.stale()) {
        reload();
    }
}

void OperatorWindow::refresh() {
    const double h = static_cast<double>(since_refresh_.restart()) * 1e-3;
    control_.refresh();
    move_hand(h);
}

/// The view that the person mainly looks at.
SceneWidget& OperatorWindow::first_scene() {
    return participants_.first() == nullptr ? *scene_ : *participants_.first();
}

void OperatorWindow::show_frame(const frame::Frame& frame) {
    first_scene().set_patch(patch_of(control_.runner().plan(), frame));
    scene_->show_frame(frame);
    participants_.each([&](SceneWidget& scene) { scene.show_frame(frame); });
    show_question();
}

void OperatorWindow::show_question() {
    const std::optional<Asked> asked = control_.asked();
    scene_->ask(asked);
    participants_.each([&](SceneWidget& scene) { scene.ask(asked); });
}

void OperatorWindow::move_hand(double h) {
    const SessionRunner& runner = control_.runner();
    if (!mouse_ || !runner.running()) return;
    const frame::Frame& frame = runner.frame();
    if (frame.sequence < 0) return;
    mouse_->set_grip(frame.grip_force);
    mouse_->squeeze(scene_->keys(), std::min(h, kLongestStep));
    runner.plan().mouse->follow(mouse_->goal());
}

void OperatorWindow::show_participant_window(bool shown) {
    participants_.close();
    if (!shown) return;
    const auto& plan = control_.plan();
    const SessionRunner& runner = control_.runner();
    participants_.open(plan ? plan->rig : rig::Rig{});
    const bool has_frame = runner.running() && runner.frame().sequence >= 0;
    if (plan)
        participants_.set_scene(plan->scene, has_frame ? runner.frame() : control_.first_frame(),
                                plan->rig);
    follow_in_headset();
    turn_workspaces();
    show_state();
}

/// If there is a headset, lets it read the frames of the running session.
void OperatorWindow::follow_in_headset() {
    const SessionRunner& runner = control_.runner();
    if (HeadsetView* const headset = participants_.headset(); headset && runner.running())
        headset->follow(runner.plan().scene, runner.second());
}

void OperatorWindow::show_state() {
    mark_picked();
    const TaskTexts::Words words = control_.words();
    const SessionSign sign = sign_of(control_);
    if (sign.sign == Sign::running) {
        scene_->set_banner(words.message);
    } else {
        scene_->set_sign(sign.word, sign.text, sign.sign);
    }
    scene_->set_help(control_.may(SessionControl::Act::move) ? hand_help() : "");
    scene_->set_page(words.page, words.picture);
    show_question();
    const auto show_words = [&](auto& to) {
        to.set_banner(words.message);
        to.set_page(words.page, words.picture);
    };
    participants_.each(show_words);
    if (HeadsetView* const headset = participants_.headset()) show_words(*headset);
}

void OperatorWindow::log(const QString& text, bool problem) {
    log_->add(text, problem);
}

void OperatorWindow::closeEvent(QCloseEvent* event) {
    if (control_.runner().running()) {
        // the window closes as soon as the session's files are written
        if (closing_ == Closing::no) closing_ = Closing::after_session;
        control_.runner().end();
        log(tr("ending the session ..."));
        event->ignore();
        return;
    }
    const bool now = closing_ == Closing::by_signal || closing_ == Closing::unseen;
    if (now) {
        leave_text();  // it is too late to ask the user
    } else if (!may_leave_text()) {
        closing_ = Closing::no;
        return event->ignore();
    }
    QSettings settings;
    settings.setValue("geometry", saveGeometry());
    settings.setValue("docks", saveState());
    modes_->store();
    participants_.close();
    event->accept();
    // windows with recorded sessions must not keep the program running
    QMetaObject::invokeMethod(qApp, &QApplication::closeAllWindows, Qt::QueuedConnection);
    // exits even if a dialog is open
    if (now) QCoreApplication::exit(closing_ == Closing::by_signal ? 1 : 0);
}

}  // namespace dihaptic::gui
