#include "session_runner.h"

#include <QCursor>
#include <QFileInfo>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace dihaptic::gui {
namespace {

constexpr int kBeat = 100;        // a tenth of Live::kLongestSilence [ms]
constexpr int kFirstBeat = 5000;  // time limit for the first beat, even without a picture [ms]

/// Waits until the display answers, because a key can switch force off only if the display works.
/// Asking X for the pointer's position returns only once X has answered.
void ask_display() {
    QCursor::pos();
}

std::atomic<SessionRunner*> the_runner{nullptr};

SessionEnd::Way way_of(const session::Recorded& recorded, const session::Plan& plan) {
    if (!recorded.fault.empty()) return SessionEnd::Way::broken_off;
    return plan.task && recorded.info.state != recording::SessionState::complete
               ? SessionEnd::Way::unfinished
               : SessionEnd::Way::whole;
}

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
    runner->stop_ = true;  // takes effect in the servo's next tick
    std::fprintf(stderr, "The window is lost: force is off, and the session ends.\n");
    while (runner->busy_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::fflush(nullptr);
    std::_Exit(1);  // not exit(), whose handlers would use the lost window
}

void SessionRunner::pause_at_once() {
    SessionRunner* const runner = the_runner;
    if (runner == nullptr) return;
    const std::lock_guard lock(runner->coming_and_going_);
    if (!runner->running() || runner->session_->live.paused.exchange(true)) return;
    QMetaObject::invokeMethod(runner, &SessionRunner::paused_at_once, Qt::QueuedConnection);
}

void SessionRunner::watch() {
    if (!running() || alive_.isActive()) return;
    first_beat_.stop();
    session_->live.note_alive();
    alive_.start();
}

void SessionRunner::start(session::Plan plan, session::RunOptions options, double pace,
                          std::unique_ptr<devices::DeviceGroup> devices,
                          std::shared_ptr<Latest<frame::Frame>> second) {
    {
        const std::lock_guard lock(coming_and_going_);
        session_ = std::make_unique<Session>();
    }
    session_->live.second = std::move(second);
    no_suspension_.emplace();
    session_->plan = std::move(plan);
    session_->devices = std::move(devices);
    session_->knobs = frame::Knobs::of(session_->plan.settings);
    // force is also switched off if the window never sends a beat
    session_->live.note_alive(kFirstBeat * 1e-3);
    first_beat_.start();
    // registered again for each session, so that exit() calls it before it destroys objects that
    // were made before the session
    std::atexit(end_program);
    options.live = &session_->live;
    options.observers = true;
    options.keys = &session_->keys;
    session_->clock = options.clock;
    session_->live.pace = pace;
    options.warn = [this](const std::string& message) {
        QMetaObject::invokeMethod(
            this, [this, said = QString::fromStdString(message)] { Q_EMIT warned(said); },
            Qt::QueuedConnection);
    };
    options.stuck = [](const std::string& message) {
        std::fprintf(stderr, "%s\n", message.c_str());
        std::_Exit(1);  // an orderly exit would wait for a stuck thread
    };
    busy_ = true;
    thread_ = std::thread([this, options] {
        SessionEnd end = run(*session_, options);
        busy_ = false;
        QMetaObject::invokeMethod(
            this,
            [this, end]() mutable {
                thread_.join();
                conclude(end);
                {
                    const std::lock_guard lock(coming_and_going_);
                    session_.reset();
                }
                alive_.stop();
                first_beat_.stop();
                no_suspension_.reset();
                Q_EMIT ended(end);
            },
            Qt::QueuedConnection);
    });
}

SessionEnd SessionRunner::run(Session& session, const session::RunOptions& options) {
    SessionEnd end;
    try {
        const session::Recorded recorded = session::record(
            session.plan, options, stop_, {},
            [&](const std::string& folder, double share) {
                end.folder = QString::fromStdString(folder);
                session.finishing = true;
                QMetaObject::invokeMethod(
                    this, [this, share] { Q_EMIT finishing_progressed(share); },
                    Qt::QueuedConnection);
            },
            std::move(session.devices));
        for (const std::string& note : recorded.notes)
            (note.starts_with("note:") ? end.asides : end.messages) += QString::fromStdString(note);
        end.asides += QString::fromStdString(recorded.figures.convergence.describe());
        end.good = recorded.good();
        end.way = way_of(recorded, session.plan);
    } catch (const std::exception& e) {
        end.way = SessionEnd::Way::broken_off;
        end.messages.prepend(QString::fromStdString(e.what()));
    }
    return end;
}

void SessionRunner::conclude(SessionEnd& end) {
    const session::Plan& plan = session_->plan;
    if (!end.messages.isEmpty()) end.why = end.messages.front();
    if (end.why.startsWith("WARNING: ")) end.why.remove(0, 9);
    take_folder();
    if (end.folder.isEmpty()) end.folder = session_->folder;
    // a session that fails before its first tick removes its folder
    if (end.folder.isEmpty() || !QFileInfo::exists(end.folder)) {
        end.folder.clear();
        end.way = SessionEnd::Way::not_started;
    }
    if (!plan.task) return;
    end.trials = static_cast<int>(plan.task->trials.size());
    end.done = static_cast<int>(std::lround(session_->live.done * end.trials));
    // the window does not ask which simulated person does the trials
    end.offered = plan.resumable && plan.moved_by.mover != recording::Mover::simulated_person;
}

}  // namespace dihaptic::gui
