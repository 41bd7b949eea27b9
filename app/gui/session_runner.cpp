#include "session_runner.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "analysis/session_report.h"

namespace dihaptic::gui {
namespace {

QStringList messages_of(const experiment::Plan& plan, const analysis::SessionFigures& figures,
                        const experiment::RunResult& result) {
    QStringList out;
    if (!result.fault.empty()) out += QString::fromStdString(result.fault);
    if (!result.stall.empty()) out += QString::fromStdString(result.stall);
    if (result.timing.refusals.any()) {
        out += QString::fromStdString(
            servo::describe(result.timing.refusals, plan.settings.real_time_priority));
    }
    const bool stopped = figures.ticks_with(servo::kStopped) > 0;  // the fault says so
    for (int bit = 0; bit < servo::kStatusBits; ++bit) {
        const auto status = static_cast<servo::Status>(1u << bit);
        if (status == servo::kResumed || status == servo::kSoftStarted) continue;  // as is usual
        if (stopped && (status == servo::kStopped || status == servo::kForceOff)) continue;
        const int64_t ticks = figures.ticks_with(status);
        if (ticks == 0) continue;
        const servo::StatusText text = servo::describe(status);
        out += QString::fromStdString(fmt::format("In {} of {} ticks {}: {}.", ticks,
                                                  figures.frames, text.what, text.remedy));
    }
    if (result.dropped > 0)
        out +=
            QString("%1 frames could not be recorded: the disk is too slow.").arg(result.dropped);
    return out;
}

}  // namespace

SessionRunner::~SessionRunner() {
    if (running()) end();
    if (thread_.joinable()) thread_.join();
}

void SessionRunner::start(experiment::Plan plan, experiment::RunOptions options) {
    session_ = std::make_unique<Session>();
    session_->plan = std::move(plan);
    options.live = &session_->live;
    options.keys = &session_->key;
    options.clock = experiment::Clock::real;
    options.stuck = [](const std::string& message) {
        std::fprintf(stderr, "%s\n", message.c_str());
        std::_Exit(1);  // its threads never end
    };
    thread_ = std::thread([this, options] {
        const SessionEnd end = run(*session_, options);
        QMetaObject::invokeMethod(
            this,
            [this, end] {
                thread_.join();
                session_.reset();
                Q_EMIT ended(end);
            },
            Qt::QueuedConnection);
    });
}

SessionEnd SessionRunner::run(Session& session, const experiment::RunOptions& options) {
    SessionEnd end;
    try {
        const experiment::RunResult result =
            experiment::run_session(session.plan, options, session.stop, {});
        end.folder = QString::fromStdString(result.folder);
        session.finishing = true;
        const analysis::SessionFigures figures = analysis::finish_session(
            recording::SessionFolder::open(result.folder), result.info, [this](double share) {
                QMetaObject::invokeMethod(
                    this, [this, share] { Q_EMIT finishing_progressed(share); },
                    Qt::QueuedConnection);
            });
        end.messages = messages_of(session.plan, figures, result);
        end.good = !result.interrupted && !figures.failed();
    } catch (const std::exception& e) {
        end.messages += QString::fromStdString(e.what());
    }
    return end;
}

}  // namespace dihaptic::gui
