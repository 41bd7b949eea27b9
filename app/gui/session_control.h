// Controls sessions, without a widget: reads the open file, starts a session of it, and follows the
// session to its end. The window and its panels subscribe to the signals.
#pragma once

#include <QFileSystemWatcher>
#include <QObject>
#include <QTimer>
#include <optional>

#include "loader.h"
#include "questions_view.h"
#include "session_progress.h"
#include "session_runner.h"
#include "trial_figures.h"

namespace dihaptic::gui {

class SessionControl : public QObject {
    Q_OBJECT

  public:
    enum class State {
        no_file,   ///< no file without errors has been read
        opening,   ///< a file is being read
        checked,   ///< the file has no errors
        starting,  ///< the file is read again, and the devices are opened, for a session
        running,
        paused,
        finishing,  ///< the ticks are over, and files are being written
    };
    /// What a state allows. `prepare`: the checks and questions before a session. `move`: moving
    /// the hand by mouse.
    enum class Act { open, start, prepare, calibrate, pause, stop, skip, step, move, force_off };
    /// What a session needs besides its plan.
    struct Start {
        recording::Participant participant;
        bool by_person = false;  ///< a simulated person moves the hand
        double pace = 1;         ///< SessionRunner's
        std::optional<recording::InStudy> in_study = std::nullopt;  ///< place of a resumed session
    };

    /// `out`, `sync` and `stop`: OperatorWindow's.
    SessionControl(QString out, double sync, std::atomic<bool>& stop);

    State state() const;
    bool may(Act act) const;
    const QString& out() const { return out_; }
    void set_out(const QString& folder);
    const QString& file() const { return file_; }
    /// The plan of the last version of the file without errors; nullopt: there has been none.
    const std::optional<session::Plan>& plan() const { return plan_; }
    /// The plan's first frame.
    const frame::Frame& first_frame() const { return frame_; }
    SessionRunner& runner() { return runner_; }
    const SessionRunner& runner() const { return runner_; }
    /// Whether the running session or, if none runs, the file has trials.
    bool has_trials() const;
    bool loading() const { return loader_.loading(); }
    /// Whether the last session was ended by `stop`.
    bool cut() const { return cut_; }
    /// Whether the file has changed while it could not be read again.
    bool stale() const { return changed_; }
    /// Folder of this file's last session; empty: none.
    const QString& recorded() const { return recorded_; }
    /// Fault of the file, or reason for the session's pause; empty: none.
    const QString& complaint() const { return complaint_; }
    /// What the running task shows.
    struct Words {
        QString message;  ///< texts over the scene
        QString page;     ///< text of the page in place of the scene
        QString picture;  ///< picture of that page
    };
    Words words() const;
    /// The form that is filled in now, or the rating that a click can answer; nullopt: none.
    std::optional<Asked> asked() const;

    /// Another file is open from now on. It is watched; read() reads it.
    void open(const QString& file);
    /// Watches the file again, if another program has replaced it.
    void watch();
    /// Reads the file, once no session runs or starts. `text`: replaces its content.
    void read(const session::Request& request, const std::optional<std::string>& text);
    /// Whether the file's text has unsaved changes.
    void set_edited(bool edited) { edited_ = edited; }
    /// Whether the checks before a session may begin now. If the file is still being read,
    /// start_due() follows when it has been.
    bool want_start();
    /// Keeps a session that is about to start from starting.
    void drop_start() { starts_.reset(); }
    /// Drops the session about to start, and also a start that waits for the file.
    void forget_start();
    /// Reads the file again, so that the session uses its present content, and starts. `resumes`:
    /// folder of the session to continue, whose frozen files are read instead; "": none. To be
    /// called only after the checks, which Act::prepare allows.
    void begin(session::Request request, const Start& start, const std::string& resumes);
    /// Ends the session, or the reading of a file.
    void stop();
    void skip();
    void pause(bool paused);
    /// Pauses the session, if one is running. `why`: the reason, if the operator must be told.
    void take_force_away(const QString& why = "");
    void set_pace(double pace);
    void turn_knobs(const frame::Knobs& knobs, const QString& what);
    /// Passes on a key that a task may wait for.
    void press(char key);
    void click(const task::Click& click);
    /// Passes on what the session has produced since the last call; to be called for each picture.
    void refresh();

  Q_SIGNALS:
    /// The state, or a text, may have changed.
    void changed();
    void logged(const QString& text, bool problem);
    /// The file should be read again.
    void file_changed();
    /// The file has no errors.
    void opened(const dihaptic::gui::Opened& opened);
    /// Errors or warnings of the file that was read.
    void judged(const QStringList& problems);
    void start_due();
    /// A session is about to start; options may be added.
    void prepared(const dihaptic::session::Plan& plan, dihaptic::session::RunOptions& options);
    void started(const dihaptic::session::Plan& plan);
    void sampled(const dihaptic::session::CurveSample& sample);
    void trial_ended(const dihaptic::session::TrialEnd& end);
    /// Measures of the session's attempts, as in trials.csv.
    void measured(const dihaptic::Table& trials);
    void framed(const dihaptic::frame::Frame& frame);
    void progressed(const dihaptic::gui::SessionProgress& now);
    /// `share`: written share of the session's files.
    void finishing_progressed(double share);
    /// No force acts; `why` is the reason.
    void rested(const QString& why);
    void ended();

  private:
    static QString typed(const frame::TaskFrame& task, const task::TaskPlan& plan, int scale);
    void take(const Opened& opened);
    void refuse(const QStringList& problems);
    void refuse_to_start();
    void run(const Start& start, std::unique_ptr<devices::DeviceGroup> devices);
    void show(const frame::Frame& frame);
    void end(const SessionEnd& end);
    void log(const QString& text, bool problem = false) { Q_EMIT logged(text, problem); }

    QString out_;
    double sync_;
    Loader loader_;
    SessionRunner runner_;
    TrialFigures figures_;
    QString file_;
    QFileSystemWatcher watcher_;
    QTimer reload_;  ///< delays reading a changed file: editors write it in several steps
    std::optional<session::Plan> plan_;
    frame::Frame frame_;
    QString said_;   ///< the task's texts that are shown
    int page_ = -1;  ///< index of the task's page that is shown; -1: none
    bool start_when_opened_ = false;
    std::optional<Start> starts_;  ///< the session that starts when the file has been read
    bool edited_ = false;
    bool text_is_wrong_ = false;  ///< whether the unsaved text has errors
    bool changed_ = false;
    bool cut_ = false;
    QString recorded_;
    QString complaint_;
};

}  // namespace dihaptic::gui
