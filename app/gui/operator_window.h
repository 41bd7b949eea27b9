// The operator's window: the scene, surrounded by panels for the session, its devices, plots and
// knobs. The session itself is SessionControl's. The window's menus are in operator_menus.cpp, the
// handling of the open file in operator_files.cpp, and the steps before a session in
// operator_start.cpp.
#pragma once

#include <QElapsedTimer>
#include <QMainWindow>
#include <QStackedWidget>
#include <optional>

#include "calibrator.h"
#include "checklist.h"
#include "composer.h"
#include "log_view.h"
#include "participant_dialog.h"
#include "participant_windows.h"
#include "session_control.h"
#include "session_panel.h"
#include "start_page.h"

namespace dihaptic::gui {

class PlotsPanel;
class ParticipantMirror;
class TrialsPanel;
class TuningPanel;

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
    /// stays open.
    void open(const QString& file);
    /// Pauses the running session: force is off from the servo's next tick until it continues.
    void force_off();
    /// `signal` asked the program to end, and force is already off: the window closes once the
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
    void connect_panels(PlotsPanel* plots, TrialsPanel* trials, DevicePanel* devices,
                        TuningPanel* tuning);
    void connect_mirror(ParticipantMirror* mirror);
    void make_file_menu();
    void make_session_menu();
    /// Enables an action while the session's state allows `act`.
    void enable(QAction* action, SessionControl::Act act);
    /// To be called after make_docks(), whose docks it lists.
    void make_view_menu();
    void connect_scene();
    void connect_participants();
    void connect_session();
    void connect_files();
    void restore();
    void choose_file();
    void save_as();
    void fill_recent(QMenu& menu);
    void remember(const QString& file);
    void make_help_menu();
    void choose_session();
    void play_sessions(const QStringList& folders);
    void reload();
    /// Shows the position of a clicked body in the text.
    void pick(size_t body);
    /// Moves a body in the text, and shows it at its new position until the text has been read
    /// again; `shown`: it is already shown at its new position.
    void move_body(const std::string& name, const BodyWay& way, bool shown);
    /// Moves the body whose lines contain the text cursor.
    void step_body(const Vec3& step);
    /// Puts a box around the body whose lines contain the text cursor.
    void mark_picked();
    void show_opened(const Opened& opened);
    void start();
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
    /// Saves the text, and starts as SessionControl::begin() does.
    void begin(const recording::Participant& participant, const std::string& resumes = "");
    void prepare(const session::Plan& plan, session::RunOptions& options);
    void show_start(const session::Plan& plan);
    void show_end();
    /// File of the chosen rig, or of the rig named in the open file; empty if there is none.
    QString rig_file() const;
    rig::NamedBy rig_named_by() const;
    void calibrate();
    void show_question();
    /// Turns the workspaces to the camera, if they follow it.
    void turn_workspaces();
    void refresh();
    SceneWidget& first_scene();
    void show_frame(const frame::Frame& frame);
    void move_hand(double h);
    void show_participant_window(bool shown);
    void follow_in_headset();
    /// The text over the scene: the next step, or a fault.
    QString banner() const;
    /// Shows the control's state and texts.
    void show_state();
    void log(const QString& text, bool problem = false);
    session::Request request() const;
    /// Asks whether to save or discard unsaved changes. Returns false if the user cancels.
    bool may_leave_text();
    /// Keeps unsaved changes as a draft.
    void leave_text();

    SessionControl control_;
    ParticipantWindows participants_;
    Calibrator* calibrator_;
    QStackedWidget* centre_;
    StartPage* start_page_;
    SceneWidget* scene_;
    SessionPanel* session_;
    Composer* composer_;
    LogView* log_;
    QDockWidget* compose_dock_ = nullptr;
    QAction* participant_action_ = nullptr;
    QAction* follow_action_ = nullptr;
    QMenu* camera_menu_ = nullptr;
    QElapsedTimer since_refresh_;
    recording::Participant participant_;  ///< the person who did the last trials
    std::optional<MouseHand> mouse_;      ///< hand of the running session
    bool closing_ = false;
    bool ended_ = false;  ///< a signal asked the program to end
    bool lost_ = false;   ///< another program destroyed the window
};

}  // namespace dihaptic::gui
