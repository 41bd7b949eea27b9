// Runs sessions for the window in a separate thread, so that the window never waits for one, and
// switches their force off when the window hangs or disappears.
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

/// The outcome of a session.
struct SessionEnd {
    QString folder;        ///< folder of the recording; empty: the session never started
    QStringList messages;  ///< faults, with remedies
    bool good = false;     ///< no faults
};

class SessionRunner : public QObject {
    Q_OBJECT

  public:
    /// `stop`: when it is set, force goes off at once and the session ends; it must outlive this
    /// object. A program has only one SessionRunner.
    explicit SessionRunner(std::atomic<bool>& stop);
    /// Ends the session properly and waits for its files.
    ~SessionRunner() override;

    /// Starts a session on its open devices, as session::run_session() does; one at a time. Sets
    /// `options.live`. `pace`: pace of a session on the virtual clock, as in set_pace(). `second`
    /// also receives the frames, unless it is null.
    void start(session::Plan plan, session::RunOptions options, double pace,
               std::unique_ptr<devices::DeviceGroup> devices = nullptr,
               std::shared_ptr<Latest<frame::Frame>> second = nullptr);
    bool running() const { return session_ != nullptr; }
    /// The ticks are over, and files are being written.
    bool finishing() const { return running() && session_->finishing; }

    /// Call when the window shows the session: from now on force goes off if the window stops
    /// responding. Not before, because drawing a scene for the first time may take longer.
    void watch();

    // the functions below, up to end(), may be called only while running
    const session::Plan& plan() const { return session_->plan; }
    /// The frames passed to start().
    std::shared_ptr<Latest<frame::Frame>> second() const { return session_->live.second; }
    /// The newest frame. It is valid until the next call, after which the servo overwrites it, so
    /// do not keep references into it.
    const frame::Frame& read_frame() {
        session_->read = &session_->live.frame.read();
        return *session_->read;
    }
    /// The last frame that read_frame() returned.
    const frame::Frame& frame() const { return *session_->read; }
    std::optional<session::CurveSample> take_sample() { return session_->live.take_sample(); }
    std::optional<session::TrialEnd> take_trial_end() { return session_->live.take_trial_end(); }
    void set_paused(bool paused) { session_->live.paused = paused; }
    /// The folder of the session's recording, returned only once; "" before it is known.
    QString take_folder() { return QString::fromStdString(session_->live.take_folder()); }
    /// The reason why the session has paused by itself since the last call; "" if it has not.
    QString take_told() { return QString::fromStdString(session_->live.take_told()); }
    bool paused() const { return session_->live.paused; }
    /// Turns the knobs toward these values, except for the workspaces.
    void turn_knobs(frame::Knobs knobs) {
        knobs.workspace_turn = session_->knobs.workspace_turn;
        session_->knobs = knobs;
        session_->live.knobs.publish(knobs);
    }
    /// `angle`: the angle to which the workspaces turn [rad].
    void turn_workspaces(double angle) {
        session_->knobs.workspace_turn = angle;
        session_->live.knobs.publish(session_->knobs);
    }
    /// Sets the pace of a session on the virtual clock: session time over wall time; 0: as fast as
    /// possible.
    void set_pace(double pace) { session_->live.pace = pace; }
    /// Runs this many ticks of a paused session.
    void step(int ticks) { session_->live.steps += ticks; }
    bool on_virtual_clock() const { return session_->clock == session::Clock::virtual_clock; }
    /// Skips the current trial.
    void skip() { session_->live.skip = true; }
    /// Share of completed trials.
    double done() const { return session_->live.done; }
    /// The picture of a tick was handed just now to the screen that the participant looks at. May
    /// be called at any time.
    void note_shown(int64_t tick) {
        if (running()) session_->live.note_shown(tick, session::Live::Clock::now());
    }
    /// A picture shown in a headset. May be called at any time.
    void note_shown(const headset::Showing& showing) {
        if (running())
            session_->live.note_shown(showing.tick, showing.at, showing.X_WV, showing.tracked);
    }
    /// Passes on a key, for a task that waits for one.
    void press(char key) { session_->keys.push(key); }
    /// Passes on a click on a question's line.
    void click(const task::Click& click) { session_->live.clicked = click; }
    /// Ends the session properly, even while the hand holds something.
    void end() { session_->live.ended = true; }
    /// Whether force was switched off for good, as by a signal; also after the session's end.
    bool stopped() const { return stop_; }
    /// Whether the session must end. May be called only while running, also from the session's
    /// thread.
    bool ending() const { return session_->live.ended || stop_; }
    /// For a program that must end without unwinding because its display is gone. If a session is
    /// running, it switches force off at once, waits for the session's files, and ends the program;
    /// otherwise it does nothing. May be called from any thread but the session's.
    static void end_program();
    /// Pauses the running session, if any, even if the window is busy or hangs: force is off from
    /// the servo's next tick on. May be called from any thread.
    static void pause_at_once();

  Q_SIGNALS:
    /// Emitted in the window's thread after pause_at_once() has paused the session.
    void paused_at_once();
    /// `share`: written share of the session's files. Both signals arrive in the window's thread.
    void finishing_progressed(double share);
    /// Messages about parts that a starting session lacks.
    void warned(const QString& message);
    void ended(const dihaptic::gui::SessionEnd& end);

  private:
    struct Session {
        session::Plan plan;
        std::unique_ptr<devices::DeviceGroup> devices;
        session::Live live;
        const frame::Frame* read = &live.frame.read();
        session::Clock clock = session::Clock::real;
        frame::Knobs knobs;  ///< values to be reached
        ValueRing<char> keys{task::kMostKeys};
        std::atomic<bool> finishing{false};
    };
    SessionEnd run(Session& session, const session::RunOptions& options);

    std::atomic<bool>& stop_;
    std::unique_ptr<Session> session_;
    std::mutex coming_and_going_;  ///< guards session_: other threads hold it while they use that
    std::optional<app::NoSuspension> no_suspension_;
    std::atomic<bool> busy_{false};  ///< thread_ runs a session, or makes its files
    QTimer alive_;                   ///< signals regularly that the window answers
    QTimer first_beat_;
    std::thread thread_;
};

}  // namespace dihaptic::gui
