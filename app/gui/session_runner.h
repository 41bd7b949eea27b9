// Runs sessions in a separate thread, so that the window never waits for one, and switches force
// off when the window hangs or disappears.
#pragma once

#include <QObject>
#include <QTimer>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "common/stop_signals.h"
#include "headset/headset.h"
#include "session/record.h"

namespace dihaptic::gui {

/// How a session ended.
struct SessionEnd {
    enum class Way {
        whole,       ///< nothing is left to do
        unfinished,  ///< it was ended before all of its trials were done
        broken_off,  ///< a fault ended it; what was recorded until then remains
        not_started
    };
    Way way = Way::not_started;
    /// Why it was broken off or did not start, with the remedy; otherwise the gravest message about
    /// the recording, or "" if there is none.
    QString why;
    bool by_text = false;  ///< whether errors of the file's text are why it did not start
    int done = 0;          ///< number of trials that are done, including those of earlier sessions
    int trials = 0;        ///< number of all trials; 0 if the session has none
    bool offered = false;  ///< whether the window will offer to continue the session
    QString folder;        ///< folder of the recording; empty if the session never started
    QStringList messages;  ///< faults, with their remedies
    QStringList asides;    ///< what need not worry the operator
    bool good = false;     ///< no faults
};

class SessionRunner : public QObject {
    Q_OBJECT

  public:
    /// `stop`: as soon as it is set, force is switched off and the session ends. `stop` must
    /// outlive this object. A program must not have more than one SessionRunner.
    explicit SessionRunner(std::atomic<bool>& stop);
    /// Ends the running session properly, and waits until its files are written.
    ~SessionRunner() override;

    /// Starts a session on its open devices, in the same way as session::run_session(); only one
    /// session can run at a time. Sets `options.live`. `pace`: pace of a session on the virtual
    /// clock, as for set_pace(). `second`, unless null, also receives the frames.
    void start(session::Plan plan, session::RunOptions options, double pace,
               std::unique_ptr<devices::DeviceGroup> devices = nullptr,
               std::shared_ptr<Latest<frame::Frame>> second = nullptr);
    bool running() const { return session_ != nullptr; }
    /// Whether the ticks have ended, and files are being written.
    bool finishing() const { return running() && session_->finishing; }

    /// To be called when the window shows the session: from now on, force is switched off if the
    /// window stops responding. Not called earlier, because drawing a scene for the first time may
    /// take longer.
    void watch();

    // the functions from here to end() may be called only while a session is running
    const session::Plan& plan() const { return session_->plan; }
    /// The frames passed to start().
    std::shared_ptr<Latest<frame::Frame>> second() const { return session_->live.second; }
    /// The newest frame. It is valid only until the next call, after which the servo overwrites it,
    /// so references into it must not be kept.
    const frame::Frame& read_frame() {
        session_->read = &session_->live.frame.read();
        return *session_->read;
    }
    /// The frame that read_frame() last returned.
    const frame::Frame& frame() const { return *session_->read; }
    std::optional<session::CurveSample> take_sample() { return session_->live.take_sample(); }
    std::optional<session::TrialEnd> take_trial_end() { return session_->live.take_trial_end(); }
    void set_paused(bool paused) { session_->live.paused = paused; }
    /// The folder of the session's recording. Returned only once; "" before it is known and
    /// afterwards.
    QString take_folder() {
        const QString folder = QString::fromStdString(session_->live.take_folder());
        if (!folder.isEmpty()) session_->folder = folder;
        return folder;
    }
    /// The reason why the session has paused by itself since the last call; "" if it has not
    /// paused.
    QString take_told() { return QString::fromStdString(session_->live.take_told()); }
    bool paused() const { return session_->live.paused; }
    /// Moves the knobs toward these values, except for the turn of the workspaces.
    void turn_knobs(frame::Knobs knobs) {
        knobs.workspace_turn = session_->knobs.workspace_turn;
        session_->knobs = knobs;
        session_->live.knobs.publish(knobs);
    }
    /// `angle`: the angle toward which the workspaces turn [rad].
    void turn_workspaces(double angle) {
        session_->knobs.workspace_turn = angle;
        session_->live.knobs.publish(session_->knobs);
    }
    /// Sets the pace of a session on the virtual clock, i.e. the ratio of session time to wall
    /// time; 0 for as fast as possible.
    void set_pace(double pace) { session_->live.pace = pace; }
    /// Runs the given number of ticks of a paused session.
    void step(int ticks) { session_->live.steps += ticks; }
    bool on_virtual_clock() const { return session_->clock == session::Clock::virtual_clock; }
    /// Skips the current trial.
    void skip() { session_->live.skip = true; }
    /// Share of completed trials.
    double done() const { return session_->live.done; }
    /// Notes that the picture of a tick has just been passed to the screen that the participant
    /// looks at. May be called at any time.
    void note_shown(int64_t tick) {
        if (running()) session_->live.note_shown(tick, session::Live::Clock::now());
    }
    /// Notes that a picture was shown in a headset. May be called at any time.
    void note_shown(const headset::Showing& showing) {
        if (running())
            session_->live.note_shown(showing.tick, showing.at, showing.X_WV, showing.tracked);
    }
    /// Passes on a note of the operator. Returns false if the session's last tick is over.
    bool add_remark(recording::Remark remark) {
        return session_->live.add_remark(std::move(remark));
    }
    /// Passes on a key press, for a task that waits for a key.
    void press(char key) { session_->keys.push(key); }
    /// Passes on a click on the line of a question.
    void click(const task::Click& click) { session_->live.clicked = click; }
    /// Ends the session properly, even while the hand holds something.
    void end() { session_->live.ended = true; }
    /// Whether force was switched off for good, e.g. because of a signal; remains valid after the
    /// session's end.
    bool stopped() const { return stop_; }
    /// Whether the session must end. May be called only while running, also from the session's
    /// thread.
    bool ending() const { return session_->live.ended || stop_; }
    /// For a program that must exit without unwinding because its display is lost. If a session is
    /// running, switches force off at once, waits for the session's files, and exits the program;
    /// otherwise does nothing. May be called from any thread except the session's.
    static void end_program();
    /// Pauses the running session, if there is one, even if the window is busy or hangs: force is
    /// off from the servo's next tick on. May be called from any thread.
    static void pause_at_once();

  Q_SIGNALS:
    /// Emitted in the window's thread after pause_at_once() has paused the session.
    void paused_at_once();
    /// `share`: share of the session's files that has been written. This signal and the next arrive
    /// in the window's thread.
    void finishing_progressed(double share);
    /// A message about a part that is missing for a session that is starting.
    void warned(const QString& message);
    void ended(const dihaptic::gui::SessionEnd& end);

  private:
    struct Session {
        session::Plan plan;
        std::unique_ptr<devices::DeviceGroup> devices;
        session::Live live;
        const frame::Frame* read = &live.frame.read();
        session::Clock clock = session::Clock::real;
        frame::Knobs knobs;  ///< target values of the knobs
        ValueRing<char> keys{task::kMostKeys};
        std::atomic<bool> finishing{false};
        QString folder;  ///< folder of the recording; "" before it is known
    };
    /// Completes what is known about the end of a session, whose thread has ended.
    void conclude(SessionEnd& end);
    SessionEnd run(Session& session, const session::RunOptions& options);

    std::atomic<bool>& stop_;
    std::unique_ptr<Session> session_;
    std::mutex coming_and_going_;  ///< guards session_; other threads lock it while using session_
    std::optional<app::NoSuspension> no_suspension_;
    std::atomic<bool> busy_{false};  ///< whether thread_ is running a session or writing its files
    QTimer alive_;                   ///< reports regularly that the window is responding
    QTimer first_beat_;
    std::thread thread_;
};

}  // namespace dihaptic::gui
