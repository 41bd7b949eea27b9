// The operator's window: the scene, surrounded by panels for the session, its devices, plots and
// knobs. Its menus are in operator_menus.cpp, the handling of the open file in operator_files.cpp,
// and the steps before a session in operator_start.cpp.
#pragma once

#include <QElapsedTimer>
#include <QFileSystemWatcher>
#include <QMainWindow>
#include <QStackedWidget>
#include <QTimer>
#include <memory>
#include <optional>

#include "calibrator.h"
#include "checklist.h"
#include "composer.h"
#include "device_panel.h"
#include "loader.h"
#include "log_view.h"
#include "participant_dialog.h"
#include "plots_panel.h"
#include "reporter.h"
#include "session_panel.h"
#include "session_runner.h"
#include "start_page.h"
#include "subject_mirror.h"
#include "subject_windows.h"
#include "trial_figures.h"
#include "trials_panel.h"
#include "tuning_panel.h"

namespace dihaptic::gui {

class OperatorWindow : public QMainWindow {
    Q_OBJECT

  public:
    /// `out`: folder for session folders. `sync`: time between synchronisations of a recording to
    /// the disk [s]; 0: only at its end. `stop`: SessionRunner's.
    OperatorWindow(QString out, double sync, std::atomic<bool>& stop);
    ~OperatorWindow() override;

    /// Shows the start page.
    void show_start_page();
    /// Opens a scene or an experiment. Problems are reported in the log, and the last good file
    /// stays.
    void open(const QString& file);
    /// Pauses the running session: force is off from the servo's next tick until it continues.
    void force_off();
    /// `signal` asked the program to end, and has ended force already: the window closes once the
    /// session's files are written.
    void end(int signal);
    /// Another program destroyed this window: the session ends, as when the window is closed, and
    /// then the program.
    void end_unseen();

  protected:
    void closeEvent(QCloseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void make_docks();
    void make_file_menu();
    void make_session_menu();
    /// To be called after make_docks(), whose docks it lists.
    void make_view_menu();
    void connect_scene();
    void connect_subjects();
    void connect_session();
    void connect_tuning();
    void connect_reports();
    /// Connects the readers of files, and reads files again when they change.
    void connect_files();
    void restore();
    void choose_file();
    void save_as();
    void fill_recent();
    void remember(const QString& file);
    void make_help_menu();
    void choose_session();
    void play_sessions(const QStringList& folders);
    void reload();
    /// Shows the position of a clicked body in the text.
    void pick(size_t body);
    /// Moves a body in the text, and shows it at its new position until the text has been read
    /// again; `shown`: it is already shown there.
    void move_body(const std::string& name, const BodyWay& way, bool shown);
    /// Moves the body whose lines contain the text cursor.
    void step_body(const Vec3& step);
    /// Puts a box around the body whose lines contain the text cursor.
    void mark_picked();
    void opened(const Opened& opened);
    void refused(const QStringList& problems);
    void start();
    void refuse_to_start();
    /// Starts the session, after all checks and questions.
    void start_checked();
    /// Shows the checklist; `before_start`: a session follows.
    void show_checklist(bool before_start);
    void remedy(session::Remedy remedy);
    void choose_folder();
    /// Opens a page of the documents.
    void show_page_of_docs(const QString& name);
    /// Asks for the person's data, then starts.
    void start_trials();
    /// Offers to continue an unfinished session of that person, if there is one.
    void begin_or_go_on(const recording::Participant& participant);
    /// Reads the file again, so that the session uses its present content, and starts. `resumes`:
    /// folder of the session to continue, whose frozen files are read instead; "": none.
    void begin(const recording::Participant& participant, const std::string& resumes = "");
    void run(const session::Plan& plan, const recording::Participant& participant,
             std::unique_ptr<devices::DeviceGroup> devices);
    /// File of the chosen rig, or of the rig named in the open file; empty if there is none.
    QString rig_file() const;
    rig::NamedBy rig_named_by() const;
    void calibrate();
    /// Writes the report of the last session.
    void report();
    void stop();
    void skip();
    /// Passes on a key that a task may wait for.
    void press(char key);
    void click(double share);
    const task::AskSpec* asked_by_mouse();
    void show_question();
    /// Turns the workspaces to the camera, if they follow it.
    void turn_workspaces();
    void pause(bool paused);
    void session_ended(const SessionEnd& end);
    void refresh();
    SceneWidget& first_scene();
    void show_frame(const frame::Frame& frame);
    void move_hand(double h);
    void show_subject_window(bool shown);
    void follow_in_headset();
    void show_progress(const frame::Frame& frame);
    bool has_trials() const;
    SessionPanel::State state() const;
    /// The task's texts over the scene; empty if there are none.
    QString message() const;
    /// Text and picture of the task's page that is shown; both empty if there is none.
    QString page_text() const;
    QString page_picture() const;
    /// The text over the scene: the next step, or a fault.
    QString banner() const;
    void update_state();
    void log(const QString& text, bool problem = false);
    session::Request request(const QString& file) const;
    /// Asks whether to save or discard unsaved changes. Returns false if the user cancels.
    bool may_leave_text();
    /// Keeps unsaved changes as a draft.
    void leave_text();

    QString out_;
    double sync_;
    QString file_;
    std::optional<session::Plan> plan_;  ///< of the last version of the file without errors
    frame::Frame frame_;                 ///< the plan's first frame
    std::vector<view::Workspace> workspaces_;
    QString said_;                        ///< the task's texts that are shown
    int page_ = -1;                       ///< index of the task's page that is shown; -1: none
    recording::Participant participant_;  ///< the person who did the last trials
    std::optional<MouseHand> mouse_;      ///< of the running session
    bool start_when_opened_ = false;
    std::optional<recording::Participant>
        starts_;                  ///< person whose session starts when the file has been read
    bool text_is_wrong_ = false;  // whether the editor's present text has errors
    bool changed_ = false;        ///< the file has changed while it could not be read again
    bool closing_ = false;
    bool ended_ = false;  ///< a signal asked the program to end
    bool lost_ = false;   ///< another program destroyed the window
    bool cut_ = false;    ///< the last session was ended by `stop`

    Loader loader_;
    SessionRunner runner_;
    SubjectWindows subjects_;
    Calibrator* calibrator_;
    Reporter reporter_;
    TrialFigures figures_;
    QStackedWidget* centre_;
    StartPage* start_page_;
    SceneWidget* scene_;
    SessionPanel* session_;
    PlotsPanel* plots_;
    TrialsPanel* trials_;
    DevicePanel* devices_;
    TuningPanel* tuning_;
    Composer* composer_;
    SubjectMirror* mirror_;
    LogView* log_;
    QDockWidget* compose_dock_ = nullptr;
    QAction* open_action_ = nullptr;
    QAction* edit_action_ = nullptr;
    QAction* undo_action_ = nullptr;
    QAction* redo_action_ = nullptr;
    QAction* save_action_ = nullptr;
    QAction* start_page_action_ = nullptr;
    QAction* start_action_ = nullptr;
    QAction* pause_action_ = nullptr;
    QAction* stop_action_ = nullptr;
    QAction* skip_action_ = nullptr;
    QAction* step_action_ = nullptr;
    QAction* back_action_ = nullptr;
    QAction* force_off_action_ = nullptr;
    QAction* calibrate_action_ = nullptr;
    QAction* register_action_ = nullptr;
    QAction* checklist_action_ = nullptr;
    QMenu* recent_menu_ = nullptr;
    QAction* subject_action_ = nullptr;
    QAction* follow_action_ = nullptr;
    QMenu* view_menu_ = nullptr;
    QMenu* camera_menu_ = nullptr;
    QTimer timer_;
    QElapsedTimer since_refresh_;
    QFileSystemWatcher watcher_;
    QTimer reload_;      ///< delays reading a changed file: editors write it in several steps
    QString recorded_;   ///< folder of this file's last session; empty: none
    QString complaint_;  ///< fault of the file, or reason for the session's pause; empty: none
};

}  // namespace dihaptic::gui
