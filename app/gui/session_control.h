// Controls sessions without using widgets: reads the open file, starts a session from it, and
// follows the session to its end. The window and its panels subscribe to the signals.
#pragma once

#include <QObject>
#include <optional>

#include "loader.h"
#include "progress_meter.h"
#include "session_runner.h"
#include "task_texts.h"
#include "trial_figures.h"
#include "watched_file.h"

namespace dihaptic::gui {

class SessionControl : public QObject {
    Q_OBJECT

  public:
    enum class State {
        no_file,   ///< no error-free file has been read
        opening,   ///< a file is being read
        checked,   ///< the file has no errors
        starting,  ///< the file is read again and the devices are opened, for a session
        running,
        paused,
        finishing,  ///< the ticks have ended, and files are being written
    };
    /// The actions that a state may allow. `prepare`: the checks and questions before a session.
    /// `move`: moving the hand by mouse.
    enum class Act { open, start, prepare, calibrate, pause, stop, skip, step, move, force_off };
    /// What is needed to start a session, in addition to its plan.
    struct Start {
        recording::Participant participant;
        bool by_person = false;  ///< whether a simulated person moves the hand
        double pace = 1;         ///< SessionRunner's
        std::optional<recording::InStudy> in_study = std::nullopt;  ///< place in a study
        std::string out = "";  ///< folder for the recording; "": where sessions go
    };

    /// The parameters have the same meaning as in OperatorWindow.
    SessionControl(QString out, double sync, std::atomic<bool>& stop);

    State state() const;
    bool may(Act act) const;
    const QString& out() const { return out_; }
    void set_out(const QString& folder);
    const QString& file() const { return file_.path(); }
    /// The plan from the last error-free version of the file; nullopt if there has been none.
    const std::optional<session::Plan>& plan() const { return plan_; }
    /// The plan's first frame.
    const frame::Frame& first_frame() const { return frame_; }
    SessionRunner& runner() { return runner_; }
    const SessionRunner& runner() const { return runner_; }
    /// Whether the running session has trials or, if none is running, whether the file does.
    bool has_trials() const;
    bool loading() const { return loader_.loading(); }
    /// Whether the last session was ended by `stop`.
    bool cut() const { return cut_; }
    /// Whether the file has changed since it was last read, but could not be read again.
    bool stale() const { return changed_; }
    /// Folder of the last session recorded from this file; empty if there is none.
    const QString& recorded() const { return recorded_; }
    /// How the last session ended, or why it did not start; nullopt once another file has been
    /// opened or another session is about to start.
    const std::optional<SessionEnd>& last_end() const { return last_end_; }
    /// A fault of the file, or the reason why the session is paused; empty if there is none.
    const QString& complaint() const { return complaint_; }
    /// Whether the session is paused because Escape was pressed.
    bool escaped() const { return escaped_; }
    /// The texts that the running task shows.
    TaskTexts::Words words() const;
    /// The form that is being filled in, or the rating that can be answered with a click; nullopt
    /// if there is none.
    std::optional<Asked> asked() const;

    /// Makes `file` the open file, and watches it. The file is read by read().
    void open(const QString& file);
    /// Watches the file again if another program has replaced it.
    void watch() { file_.watch(); }
    /// Reads the file as soon as no session is running or starting. `text`: used instead of the
    /// file's contents, if given.
    void read(const session::Request& request, const std::optional<std::string>& text);
    /// Sets whether the file's text has unsaved changes.
    void set_edited(bool edited) {
        if (edited != this->edited()) text_ = edited ? Text::edited : Text::saved;
    }
    /// Whether the checks before a session may begin now. If the file is still being read,
    /// start_due() will be emitted afterwards.
    bool want_start();
    /// Cancels the session that is about to start.
    void drop_start() { starts_.reset(); }
    /// Cancels the session that is about to start, including a start that is still waiting for the
    /// file to be read.
    void forget_start();
    /// Tells that the session that was wanted does not start. `why`: the reason, with its remedy;
    /// `by_text`: whether an error of the file's text is the reason.
    void refuse_to_start(const QString& why, bool by_text = false);
    /// Starts a session, after reading the file again so that the session uses its current
    /// contents. `resumes`: folder of the session to be continued, whose frozen files are read
    /// instead; "" for a new session. To be called only after the checks for which Act::prepare
    /// stands.
    void begin(session::Request request, const Start& start, const std::string& resumes);
    /// Ends the session, or stops reading the file.
    void stop();
    void skip();
    void pause(bool paused);
    /// Pauses the session, if one is running. `why`: the reason, if the operator must be informed;
    /// "" if Escape was pressed.
    void take_force_away(const QString& why = "");
    void set_pace(double pace);
    /// The operator begins to write a note: it will have the present time and trial. Has no effect
    /// while a note has been begun.
    void begin_note();
    void drop_note() { begun_.reset(); }
    /// Adds a note to the running session, at the time at which it was begun.
    void note(const QString& text);
    void turn_knobs(const frame::Knobs& knobs, const QString& what);
    /// Passes on a key press for which a task may be waiting.
    void press(char key);
    void click(const task::Click& click);
    /// Reports what the session has produced since the last call. To be called for each picture.
    void refresh();

  Q_SIGNALS:
    /// The state or one of the texts may have changed.
    void changed();
    void logged(const QString& text, bool problem);
    /// The file should be read again.
    void file_changed();
    /// The file was read without errors.
    void opened(const dihaptic::gui::Opened& opened);
    /// The errors or warnings of the file that was read.
    void judged(const QStringList& problems);
    void start_due();
    /// The operator ends the session; until the receivers return, it accepts notes.
    void ending();
    /// A session is about to start; the receiver may add options.
    void prepared(const dihaptic::session::Plan& plan, dihaptic::session::RunOptions& options);
    void started(const dihaptic::session::Plan& plan);
    void sampled(const dihaptic::session::CurveSample& sample);
    void trial_ended(const dihaptic::session::TrialEnd& end);
    /// The measures of the session's attempts, as in trials.csv.
    void measured(const dihaptic::Table& trials);
    void framed(const dihaptic::frame::Frame& frame);
    void progressed(const dihaptic::gui::SessionProgress& now);
    /// `share`: share of the session's files that has been written.
    void finishing_progressed(double share);
    /// No force acts. `why`: the reason.
    void rested(const QString& why);
    void ended();

  private:
    void take(const Opened& opened);
    void refuse(const QStringList& problems, bool of_file);
    void refuse_text_to_start();
    void pause_for_escape();
    void run(const Start& start, std::unique_ptr<devices::DeviceGroup> devices);
    void show(const frame::Frame& frame);
    void end(const SessionEnd& end);
    void log(const QString& text, bool problem = false) { Q_EMIT logged(text, problem); }
    bool edited() const { return text_ != Text::saved; }

    /// The file's text in the editor. `wrong`: it has unsaved changes and errors.
    enum class Text { saved, edited, wrong };

    QString out_;
    double sync_;
    Loader loader_;
    SessionRunner runner_;
    TrialFigures figures_;
    WatchedFile file_;
    std::optional<session::Plan> plan_;
    frame::Frame frame_;
    TaskTexts texts_;
    ProgressMeter meter_;
    bool start_when_opened_ = false;
    std::optional<Start> starts_;  ///< the session to start once the file has been read
    Text text_ = Text::saved;
    bool changed_ = false;
    bool cut_ = false;
    bool escaped_ = false;
    QString recorded_;
    QString complaint_;
    std::optional<SessionEnd> last_end_;
    std::optional<recording::Remark> begun_;  ///< a note that the operator is writing
};

}  // namespace dihaptic::gui
