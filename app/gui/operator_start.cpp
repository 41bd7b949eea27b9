// The operator's window: the steps before a session, up to its start.
#include "operator_window.h"

#include <fmt/format.h>

#include <QDate>
#include <QDateTime>
#include <QDir>
#include <QLocale>
#include <QMessageBox>
#include <QPushButton>
#include <filesystem>
#include <limits>

#include "common/study_turn.h"
#include "rig/calibration_guide.h"

namespace dihaptic::gui {
namespace {

QString mouse_help() {
    return QObject::tr(
        "Move the mouse: the hand moves.   Shift + move: toward you and away.\n"
        "Wheel down, or hold Space: squeeze.   Wheel up, or hold V: let go.\n"
        "Drag: turn.   Right drag: look around.   Ctrl + wheel: zoom.\n"
        "H: the hand stays, or moves on.   F4: it goes back to its start.   Escape: force off.");
}
QString finger_help() {
    return QObject::tr(
        "Move the mouse: the finger moves.   Wheel, or Shift + move: toward you and away.\n"
        "Right drag: look around.   Ctrl + wheel: zoom.\n"
        "H: the finger stays, or moves on.   F4: it goes back to its start.   Escape: force off.");
}

/// Identifier of a simulated person, unless the operator enters another.
const std::string kSimulated = "sim-001";

QString question_of(const session::Unfinished& session, const std::string& participant) {
    const QDateTime started =
        QDateTime::fromString(QString::fromStdString(session.started), Qt::ISODate).toLocalTime();
    const QString done =
        session.done == 0
            ? QObject::tr("not finished")
            : QObject::tr("stopped after %1 of %2 trials").arg(session.done).arg(session.trials);
    return QObject::tr(
               "%1 started this experiment on %2, and the session was %3. %4\n\nContinue it in the "
               "same way, or start again?")
        .arg(QString::fromStdString(participant), QLocale().toString(started, "d MMMM, HH:mm"),
             done, QString::fromStdString(session.moved_by.describe()));
}

/// Peak force of the device with the lowest peak force [N].
double least_peak(const session::Plan& plan) {
    double out = std::numeric_limits<double>::infinity();
    for (const frame::DeviceInfo& device : plan.devices)
        out = std::min(out, plan.settings.safety.largest_force(device.peak_force));
    return out;
}

}  // namespace

void OperatorWindow::start() {
    composer_->check_now();
    if (!control_.want_start()) return;
    // dangerous faults have been checked by now; the checklist is needed only for real devices
    if (rig::is_real(control_.plan()->rig)) {
        show_checklist(true);
    } else {
        start_checked();
    }
}

void OperatorWindow::show_checklist(bool before_start) {
    auto* list = new Checklist(findings(), before_start, this);
    connect(list, &Checklist::chosen, this, &OperatorWindow::remedy);
    if (before_start) connect(list, &QDialog::accepted, this, &OperatorWindow::start_checked);
    list->open();
}

std::vector<session::Finding> OperatorWindow::findings() const {
    const std::string today = QDate::currentDate().toString(Qt::ISODate).toStdString();
    return session::readiness(*control_.plan(), control_.out().toStdString(), today);
}

void OperatorWindow::remedy(session::Remedy remedy) {
    switch (remedy) {
        case session::Remedy::calibrate:
            return calibrate();
        case session::Remedy::register_display:
            return calibrator_->register_display(rig_file(), rig_named_by());
        case session::Remedy::choose_folder:
            return choose_folder();
        case session::Remedy::allow_real_time:
            return show_page_of_docs("safety");
        case session::Remedy::none:
            return;
    }
}

void OperatorWindow::start_checked() {
    if (!control_.may(SessionControl::Act::prepare)) return;
    if (session_->hand() == SessionPanel::Hand::person) {
        const QString id = session_->participant();
        begin({id.isEmpty() ? kSimulated : id.toStdString(), "", "", ""});
    } else if (control_.plan()->task) {
        start_trials();
    } else {
        begin({session_->participant().toStdString(), "", "", ""});
    }
}

void OperatorWindow::start_trials() {
    const session::Plan& plan = *control_.plan();
    const KnownPeople known(control_.out().toStdString(), plan.title,
                            control_.file().toStdString());
    auto* dialog = new ParticipantDialog(known, task::needs_number(plan.task->task), this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QDialog::accepted, this, [this, dialog, known] {
        const recording::Participant participant = dialog->participant();
        const std::string study = known.study_of(participant.id);
        if (study.empty()) return begin_or_go_on(participant);
        begin_in_study(study, participant);
    });
    dialog->open();
}

void OperatorWindow::begin_in_study(const std::string& study,
                                    const recording::Participant& participant) {
    if (!control_.may(SessionControl::Act::prepare) || !save_to_start()) return;
    const auto told = [this](const std::string& line) { log(QString::fromStdString(line)); };
    QString why;
    try {
        if (!rig::is_real(control_.plan()->rig))
            throw Error({control_.file().toStdString(), 0}, "rig", "is simulated",
                        "Choose a rig with devices.");
        const app::StudyTurn turn = app::study_turn(study, participant.id, "", false, told);
        std::error_code failed;
        if (!std::filesystem::equivalent(turn.experiment, control_.file().toStdString(), failed))
            throw Error({turn.experiment, 0}, turn.in_study.session,
                        fmt::format("is the next session of {}", participant.id),
                        "Open this file.");
        session::Request wanted = request();
        wanted.order_number = turn.in_study.number;
        wanted.seed = turn.seed;
        turn.log_begin();
        return control_.begin(wanted, {turn.participant, false, 1, turn.in_study, turn.out},
                              turn.resume);
    } catch (const Error& e) {
        why = QString::fromStdString(e.problems().front().text());
    }
    auto* box = new QMessageBox(this);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->setWindowTitle(tr("Outside the study?"));
    box->setText(tr("%1 takes part in the study, but this session would not count in it:\n\n%2")
                     .arg(QString::fromStdString(participant.id), why));
    const QPushButton* const outside =
        box->addButton(tr("Start &outside the study"), QMessageBox::DestructiveRole);
    box->setDefaultButton(box->addButton(QMessageBox::Cancel));
    connect(box, &QMessageBox::buttonClicked, this, [=, this](const QAbstractButton* pressed) {
        if (pressed == outside) begin_or_go_on(participant);
    });
    box->open();
}

void OperatorWindow::begin_or_go_on(const recording::Participant& participant) {
    if (!control_.plan() || control_.runner().running()) return;
    const auto sessions = session::find_unfinished(control_.out().toStdString(),
                                                   control_.plan()->title, participant.id);
    if (sessions.empty()) return begin(participant);
    auto* box = new QMessageBox(this);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->setWindowTitle(tr("Continue?"));
    box->setText(question_of(sessions.front(), participant.id));
    QPushButton* go_on = box->addButton(tr("Con&tinue"), QMessageBox::AcceptRole);
    QPushButton* anew = box->addButton(tr("Start &again"), QMessageBox::DestructiveRole);
    box->addButton(QMessageBox::Cancel);
    box->setDefaultButton(go_on);
    connect(box, &QMessageBox::buttonClicked, this,
            [=, this, folder = sessions.front().folder](QAbstractButton* pressed) {
                if (pressed == go_on) begin(participant, folder);
                if (pressed == anew) begin(participant);
            });
    box->open();
}

/// A session uses the file as it is on the disk.
bool OperatorWindow::save_to_start() {
    if (composer_->save()) return true;
    control_.refuse_to_start(tr("The text cannot be saved, and a session uses the saved file. %1")
                                 .arg(composer_->refusal()));
    return false;
}

void OperatorWindow::begin(const recording::Participant& participant, const std::string& resumes) {
    if (!control_.may(SessionControl::Act::prepare)) return;
    if (resumes.empty() && !save_to_start()) return;
    const bool by_person = session_->hand() == SessionPanel::Hand::person;
    control_.begin(request(), {participant, by_person, session_->pace()}, resumes);
}

void OperatorWindow::prepare(const session::Plan& plan, session::RunOptions& options) {
    const std::vector<std::string> fingers = scene::finger_names(plan.scene);
    if (rig::can_check_together(plan.rig, fingers)) {
        options.check = calibrator_->together_check(plan.rig, fingers,
                                                    [this] { return control_.runner().ending(); });
    }
    start_page_->rest();
    modes_->set(Mode::run);
    centre_->setCurrentWidget(scene_);
}

void OperatorWindow::show_start(const session::Plan& plan) {
    follow_in_headset();
    if (plan.mouse) {
        mouse_.emplace(plan.mouse->goal(), MouseHand::grip_of(least_peak(plan)));
        const bool squeezes = plan.scene.fingers.size() > 1;
        scene_->set_hand(&*mouse_, squeezes);
    }
    turn_workspaces();
    scene_->setFocus();
}

QString OperatorWindow::hand_help() const {
    return control_.runner().plan().scene.fingers.size() > 1 ? mouse_help() : finger_help();
}

QString OperatorWindow::rig_file() const {
    QString rig = session_->rig();
    if (rig.isEmpty() && control_.plan())
        rig = QString::fromStdString(control_.plan()->rig.place.file);
    return rig.isEmpty() ? "" : QDir::cleanPath(rig);
}

rig::NamedBy OperatorWindow::rig_named_by() const {
    return session_->rig().isEmpty() ? rig::NamedBy::a_file : rig::NamedBy::the_operator;
}

void OperatorWindow::calibrate() {
    if (!control_.may(SessionControl::Act::calibrate)) return;
    const QString rig = rig_file();
    if (rig.isEmpty()) return log(tr("There is no rig file to calibrate: choose a rig."), true);
    calibrator_->calibrate(rig, rig_named_by());
}

}  // namespace dihaptic::gui
