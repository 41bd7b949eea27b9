#include "session_sign.h"

#include <QFileInfo>

namespace dihaptic::gui {
namespace {

/// What the devices do to a hand while the session runs.
QString about_running(const SessionRunner& runner) {
    const session::Plan& plan = runner.plan();
    if (rig::is_real(plan.rig))
        return QObject::tr("The devices push on the person's hand. Escape takes the force away.");
    if (plan.mouse)
        return QObject::tr("The mouse moves a simulated hand. Escape takes the force away.");
    return plan.moved_by.mover == recording::Mover::simulated_person
               ? QObject::tr("A simulated person moves the hand. F6 pauses.")
               : QObject::tr("A script moves the hand. F6 pauses.");
}

/// What is the case for a hand while the session waits.
QString about_waiting(const SessionRunner& runner) {
    const session::Plan& plan = runner.plan();
    if (runner.on_virtual_clock())
        return QObject::tr("Time stands still. F6 resumes, Ctrl+. does one tick, F7 ends.");
    const QString hand = rig::is_real(plan.rig)
                             ? QObject::tr("The force is off: the person may let go.")
                             : QObject::tr("The force is off.");
    const QString next = plan.task ? QObject::tr(
                                         "F6 resumes with this trial from its start, F7 "
                                         "ends the session.")
                                   : QObject::tr("F6 resumes, F7 ends the session.");
    return hand + " " + next;
}

SessionSign sign_of_waiting(const SessionControl& control) {
    const QString waits = about_waiting(control.runner());
    if (!control.complaint().isEmpty())
        return {Sign::fault, QObject::tr("Fault"), control.complaint() + "\n" + waits};
    if (control.escaped()) return {Sign::stopped, QObject::tr("Stopped by Escape"), waits};
    return {Sign::paused, QObject::tr("Paused"), waits};
}

/// How much of the session is done and where it is, and what comes next.
QString about_rest(const SessionEnd& end) {
    const QString where =
        QObject::tr("What was recorded is in %1.").arg(QFileInfo(end.folder).fileName());
    if (end.trials == 0) return where + " " + QObject::tr("F5 starts again.");
    const QString next = end.offered ? QObject::tr("F5 offers to continue.")
                                     : QObject::tr("F5 starts a new session.");
    return QObject::tr("%1 of %2 trials are done.").arg(end.done).arg(end.trials) + " " + next +
           "\n" + where;
}

SessionSign sign_of_end(const SessionEnd& end) {
    switch (end.way) {
        case SessionEnd::Way::not_started:
            return {Sign::fault, QObject::tr("Did not start"),
                    end.why + "\n" + QObject::tr("F5 tries again.")};
        case SessionEnd::Way::broken_off:
            return {Sign::fault, QObject::tr("Broken off"), end.why + "\n" + about_rest(end)};
        case SessionEnd::Way::unfinished:
            return {Sign::warning, QObject::tr("Unfinished"), about_rest(end)};
        case SessionEnd::Way::whole:
            break;
    }
    const QString where = QFileInfo(end.folder).fileName();
    if (!end.good && !end.why.isEmpty()) {
        return {Sign::warning, QObject::tr("Warning"),
                end.why + "\n" +
                    QObject::tr("Recorded in %1. Ctrl+R shows its report, F5 starts again.")
                        .arg(where)};
    }
    return {Sign::idle, QObject::tr("Recorded"),
            QObject::tr("In %1. Ctrl+R shows its report, F5 starts again.").arg(where)};
}

SessionSign sign_of_file(const SessionControl& control) {
    if (!control.complaint().isEmpty())
        return {Sign::fault, QObject::tr("The file has errors"), control.complaint()};
    if (control.last_end()) return sign_of_end(*control.last_end());
    if (control.state() == SessionControl::State::no_file)
        return {Sign::idle, QObject::tr("No file"),
                QObject::tr("Ctrl+O opens a scene or an experiment.")};
    return {Sign::idle, QObject::tr("Ready"), QObject::tr("Press F5 to start.")};
}

}  // namespace

SessionSign sign_of(const SessionControl& control) {
    using State = SessionControl::State;
    const QString name = QFileInfo(control.file()).fileName();
    switch (control.state()) {
        case State::opening:
            return {Sign::busy, QObject::tr("Opening"), name};
        case State::starting:
            return {Sign::busy, QObject::tr("Starting"),
                    QObject::tr("Reads %1, and opens the devices. F7 cancels.").arg(name)};
        case State::running:
            return {Sign::running, QObject::tr("Running"), about_running(control.runner())};
        case State::paused:
            return sign_of_waiting(control);
        case State::finishing:
            return {Sign::busy, QObject::tr("Writing files"),
                    QObject::tr("The force is off, and the session is over.")};
        case State::no_file:
        case State::checked:
            break;
    }
    return sign_of_file(control);
}

QString word_for_pause(SessionControl::State state) {
    return state == SessionControl::State::paused ? QObject::tr("Resume") : QObject::tr("Pause");
}

QString word_for_stop(SessionControl::State state) {
    using State = SessionControl::State;
    return state == State::opening || state == State::starting ? QObject::tr("Cancel")
                                                               : QObject::tr("End");
}

}  // namespace dihaptic::gui
