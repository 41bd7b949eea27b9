#include "session_runner.h"

#include <fmt/format.h>
#include <QCursor>

#include <chrono>
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
    const bool stopped = figures.ticks_with(servo::kStopped) > 0;  // result.fault says so already
    uint32_t told = figures.status & ~(servo::kPaused | servo::kResumed | servo::kSoftStarted);
    if (stopped) told &= ~(servo::kStopped | servo::kForceOff);
    servo::for_each_status(told, [&](servo::Status bit) {
        const servo::StatusText text = servo::describe(bit);
        out +=
            QString::fromStdString(fmt::format("In {} of {} ticks {}: {}.", figures.ticks_with(bit),
                                               figures.frames, text.what, text.remedy));
    });
    if (result.dropped > 0)
        out +=
            QString("%1 frames could not be recorded: the disk is too slow.").arg(result.dropped);
    return out;
}

constexpr int kBeat = 100;        // a tenth of Live::kLongestSilence [ms]
constexpr int kFirstBeat = 5000;  // latest first beat, even if there is no picture [ms]

/// Waits for the display: a key can take force away only if the display answers too. Asking X for
/// the pointer's position waits for its answer.
void ask_display() {
    QCursor::pos();
}

std::atomic<SessionRunner*> the_runner{nullptr};

}  // namespace

SessionRunner::SessionRunner(std::atomic<bool>& stop) : stop_(stop) {
    the_runner = this;
    alive_.setInterval(kBeat);
    first_beat_.setInterval(kFirstBeat);
    first_beat_.setSingleShot(true);
    connect(&first_beat_, &QTimer::timeout, this, &SessionRunner::watch);
    connect(&alive_, &QTimer::timeout, this, [this] {
        ask_display();
        if (running()) session_->live.note_alive();
    });
}

SessionRunner::~SessionRunner() {
    the_runner = nullptr;
    if (running()) end();
    if (thread_.joinable()) thread_.join();
}

void SessionRunner::end_program() {
    SessionRunner* const runner = the_runner;
    if (runner == nullptr || !runner->busy_) return;
    runner->stop_ = true;  // the servo's next tick sees it
    std::fprintf(stderr, "The window is lost: force is off, and the session ends.\n");
    while (runner->busy_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::fflush(nullptr);
    std::_Exit(1);  // not exit(), whose handlers belong to a window that is gone
}

void SessionRunner::watch() {
    if (!running() || alive_.isActive()) return;
    first_beat_.stop();
    session_->live.note_alive();
    alive_.start();
}

void SessionRunner::start(experiment::Plan plan, experiment::RunOptions options) {
    session_ = std::make_unique<Session>();
    no_suspension_.emplace();
    session_->plan = std::move(plan);
    // if the window never beats, force goes off too
    session_->live.note_alive(kFirstBeat * 1e-3);
    first_beat_.start();
    // registered anew for each session, so that exit() calls it before it destroys what was made
    // before the session
    std::atexit(end_program);
    options.live = &session_->live;
    options.keys = &session_->key;
    options.clock = experiment::Clock::real;
    options.stuck = [](const std::string& message) {
        std::fprintf(stderr, "%s\n", message.c_str());
        std::_Exit(1);  // an orderly end would wait for a thread that is stuck
    };
    busy_ = true;
    thread_ = std::thread([this, options] {
        const SessionEnd end = run(*session_, options);
        busy_ = false;
        QMetaObject::invokeMethod(
            this,
            [this, end] {
                thread_.join();
                session_.reset();
                alive_.stop();
                first_beat_.stop();
                no_suspension_.reset();
                Q_EMIT ended(end);
            },
            Qt::QueuedConnection);
    });
}

SessionEnd SessionRunner::run(Session& session, experiment::RunOptions options) {
    SessionEnd end;
    try {
        if (rig::is_real(session.plan.rig)) options.keeper = keeper::program();
        const experiment::RunResult result =
            experiment::run_session(session.plan, options, stop_, {});
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
