#include "session_progress.h"

#include <QObject>
#include <QStringList>
#include <algorithm>

namespace dihaptic::gui {
namespace {

QString duration(double seconds) {
    if (seconds < 60) return QString("%1 s").arg(seconds, 0, 'f', 1);
    const int whole = static_cast<int>(seconds);
    return QObject::tr("%1 min %2 s").arg(whole / 60).arg(whole % 60);
}

QString describe_trial(const task::TaskPlan& plan, const frame::Frame& frame) {
    const auto trials = static_cast<int>(plan.trials.size());
    const int n = std::clamp(frame.trial, 1, trials);
    const task::Trial& trial = plan.trials[static_cast<size_t>(n - 1)];
    QStringList what{QObject::tr("Trial %1 of %2").arg(n).arg(trials)};
    const auto name = [&](const auto& list, int which) {
        if (static_cast<size_t>(which) < list.size())
            what += QString::fromStdString(list[static_cast<size_t>(which)].name);
    };
    name(plan.task.rounds, trial.round);
    name(plan.task.blocks, trial.block);
    name(plan.task.conditions, trial.condition);
    if (frame.task.attempt > 1) what += QObject::tr("attempt %1").arg(frame.task.attempt);
    return what.join(" \u00b7 ");
}

}  // namespace

SessionProgress progress_of(const session::Plan& plan, const frame::Frame& frame, double done) {
    const double now = seconds(frame.time);
    if (plan.task) {
        // assumes that the remaining trials will take as long as the completed ones
        const QString left =
            done > 0 ? QObject::tr("about %1 left").arg(duration(now * (1 - done) / done))
                     : duration(now);
        return {describe_trial(*plan.task, frame), done, left};
    }
    if (plan.open_ended()) return {"", 0, duration(now)};
    const auto& phases = plan.driver->phases();
    const double end = plan.driver->duration();
    const bool has_phase = static_cast<size_t>(frame.phase) < phases.size();
    const std::string phase = has_phase ? phases[static_cast<size_t>(frame.phase)].name : "";
    return {"", now / end,
            QObject::tr("%1: %2 s left").arg(phase.c_str()).arg(end - now, 0, 'f', 1)};
}

}  // namespace dihaptic::gui
