#include "session_progress.h"

#include <QObject>
#include <QStringList>
#include <algorithm>
#include <cmath>

namespace dihaptic::gui {
namespace {

/// A duration that has been measured.
QString duration(double seconds) {
    const int whole = static_cast<int>(seconds);
    return whole < 60 ? QObject::tr("%1 s").arg(whole)
                      : QObject::tr("%1 min %2 s").arg(whole / 60).arg(whole % 60);
}

QString number_of_trial(const task::TaskPlan& plan, const frame::Frame& frame) {
    const auto trials = static_cast<int>(plan.trials.size());
    return QObject::tr("Trial %1 of %2").arg(std::clamp(frame.trial, 1, trials)).arg(trials);
}

QString names_of_trial(const task::TaskPlan& plan, const frame::Frame& frame) {
    const auto trials = static_cast<int>(plan.trials.size());
    const int n = std::clamp(frame.trial, 1, trials);
    const task::Trial& trial = plan.trials[static_cast<size_t>(n - 1)];
    QStringList what;
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

QString roughly(double seconds) {
    const auto to = [](double value, int step) {
        return std::max(1, static_cast<int>(std::lround(value / step))) * step;
    };
    const double minutes = seconds / 60;
    if (seconds < 7.5) return QObject::tr("a few seconds");
    if (seconds < 57.5) return QObject::tr("%1 s").arg(to(seconds, 5));
    if (minutes < 12.5) return QObject::tr("%1 min").arg(to(minutes, 1));
    const int rounded = to(minutes, 5);
    if (rounded < 60) return QObject::tr("%1 min").arg(rounded);
    return rounded % 60 == 0 ? QObject::tr("%1 h").arg(rounded / 60)
                             : QObject::tr("%1 h %2 min").arg(rounded / 60).arg(rounded % 60);
}

SessionProgress progress_of(const session::Plan& plan, const frame::Frame& frame, double done,
                            double pace, const ProgressStart& start) {
    const double now = seconds(frame.time);
    if (plan.task) {
        // assumes that the remaining trials will take as long as those completed in this session
        const double taken = (now - start.time) / (done - start.done) / pace;
        const QString left = done > start.done
                                 ? QObject::tr("about %1 left").arg(roughly(taken * (1 - done)))
                                 : duration(now);
        return {number_of_trial(*plan.task, frame), names_of_trial(*plan.task, frame), done, left};
    }
    if (plan.open_ended()) return {"", "", 0, duration(now)};
    const auto& phases = plan.driver->phases();
    const double end = plan.driver->duration();
    const bool has_phase = static_cast<size_t>(frame.phase) < phases.size();
    const std::string phase = has_phase ? phases[static_cast<size_t>(frame.phase)].name : "";
    return {"", "", now / end,
            QObject::tr("%1: %2 left").arg(phase.c_str(), duration((end - now) / pace))};
}

}  // namespace dihaptic::gui
