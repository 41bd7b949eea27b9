// The operator's window: the scene, surrounded by panels for the session, its devices, plots and
// knobs. The session itself is run by SessionControl. The window's menus are in operator_menus.cpp,
// the handling of the open file is in operator_files.cpp, and the steps before a session are in
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
#include "modes.h"
#include "new_files.h"
#include "participant_dialog.h"
#include "participant_windows.h"
#include "session_control.h"
#include "session_panel.h"
#include "start_page.h"

namespace dihaptic::gui {

class PlotsPanel;
class ParticipantMirror;
class Reporter;
class TrialsPanel;
class TuningPanel;

class OperatorWindow : public QMainWindow {
    Q_OBJECT

  public:
    /// `out`: folder in which session folders are made. `sync`: interval at which a recording is
    /// synchronised to the disk [s]; 0 to synchronise only at its end. `stop`: passed on to
    /// SessionRunner.
    OperatorWindow(QString out, double sync, std::atomic<bool>& stop);
    ~OperatorWindow() override;

    /// Shows the start page.
    void show_start_page();
    /// Opens a scene or an experiment. Problems are reported in the log; if the file has errors,
    /// the last good file stays open.
    void open(const QString& file);
    /// Pauses the running session: force is off from the servo's next tick until the session
    /// continues.
    void force_off();
    /// Handles a `signal` that asked the program to end, with force already off: closes the window
    /// as soon as the session's files are written.
    void end(int signal);
    /// Handles the destruction of this window by another program: ends the session, as when the
    /// window is closed, and then the program.
    void end_unseen();

  protected:
    void closeEvent(QCloseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void make_docks();
    void connect_checks(ChecksView* checks);
    void connect_panels(PlotsPanel* plots, TrialsPanel* trials, DevicePanel* devices,
                        TuningPanel* tuning);
    void connect_mirror(ParticipantMirror* mirror);
    void make_file_menu();
    void add_new_files(QMenu& menu);
    void add_recordings(QMenu& menu);
    void make_edit_menu();
    void find();
    void show_or_hide_text();
    void show_text();
    void make_session_menu();
    /// Keeps an action enabled while the session's state allows `act`.
    void enable(QAction* action, SessionControl::Act act);
    /// Makes the View menu. To be called after make_docks(), because the menu lists the docks.
    void make_view_menu();
    void connect_scene();
    void connect_participants();
    void connect_session();
    void connect_files();
    void restore();
    void choose_file();
    void make_new(NewFiles::Kind kind);
    void save_as();
    void fill_recent(QMenu& menu);
    void remember(const QString& file);
    void make_help_menu();
    void choose_session();
    void show_shelves();
    /// Shows what the mode has in the middle of the window.
    void show_mode(Mode mode);
    /// Lists the recorded sessions in the middle of the window.
    void look_at_sessions();
    void play_sessions(const QStringList& folders);
    /// Writes the report of a session, and shows it in the browser. `folder`: "" if there is none.
    void report(const QString& folder);
    /// Says why a file is not opened; what is open stays open.
    void refuse_to_open(const QString& why);
    void reload();
    /// Shows where a clicked body is defined in the text.
    void pick(size_t body);
    /// Moves a body in the text, and shows it at its new position until the text has been read
    /// again. `shown`: whether the body is already shown at its new position.
    void move_body(const std::string& name, const BodyWay& way, bool shown);
    /// Moves the body whose definition contains the text cursor.
    void step_body(const Vec3& step);
    /// Shows the numbers of a body that is being dragged.
    void show_drag(size_t body, const Pose& X_WB);
    /// Shows how bodies are moved, if they can be moved now.
    void show_compose_help();
    /// Marks the body whose definition contains the text cursor by a box.
    void mark_picked();
    void show_opened(const Opened& opened);
    void start();
    /// Starts the session, after all checks and questions.
    void start_checked();
    /// Shows the checklist. `before_start`: whether a session follows.
    void show_checklist(bool before_start);
    /// What is to be checked before a session of the open file.
    std::vector<session::Finding> findings() const;
    void remedy(session::Remedy remedy);
    void choose_folder();
    /// Opens a page of the documentation.
    void show_page_of_docs(const QString& name);
    /// Asks for the participant's data, then starts the session.
    void start_trials();
    /// If the person has an unfinished session, offers to continue it.
    void begin_or_go_on(const recording::Participant& participant);
    /// Starts the next session that a study has for the participant, as `dihaptic run STUDY` does.
    /// If the study's rules are against it, says so, and offers a session outside the study.
    void begin_in_study(const std::string& study, const recording::Participant& participant);
    /// Saves the text for a session that is to start. If this fails, the sign says why none starts.
    bool save_to_start();
    /// Saves the text, and starts a session with SessionControl::begin().
    void begin(const recording::Participant& participant, const std::string& resumes = "");
    void prepare(const session::Plan& plan, session::RunOptions& options);
    void show_start(const session::Plan& plan);
    void show_end();
    /// Path of the chosen rig or, if none is chosen, of the rig named in the open file; empty if
    /// there is none.
    QString rig_file() const;
    rig::NamedBy rig_named_by() const;
    void calibrate();
    void show_question();
    /// Turns the workspaces to match the camera, if they follow it.
    void turn_workspaces();
    void refresh();
    SceneWidget& first_scene();
    void show_frame(const frame::Frame& frame);
    void move_hand(double h);
    void show_participant_window(bool shown);
    void follow_in_headset();
    /// The hint how the mouse moves the hand of the running session.
    QString hand_help() const;
    /// Updates the window to the state and the texts of the session control.
    void show_state();
    void log(const QString& text, bool problem = false);
    session::Request request() const;
    /// Asks whether to save or to discard unsaved changes. Returns false if the user cancels.
    bool may_leave_text();
    /// Keeps unsaved changes as a draft.
    void leave_text();

    SessionControl control_;
    ParticipantWindows participants_;
    Calibrator* calibrator_;
    Reporter* reporter_ = nullptr;
    Modes* modes_;
    NewFiles* new_files_;
    QStackedWidget* centre_;
    StartPage* start_page_;
    SceneWidget* scene_;
    SessionPanel* session_;
    Composer* composer_;
    LogView* log_;
    QDockWidget* compose_dock_ = nullptr;
    QDockWidget* tuning_dock_ = nullptr;
    QAction* participant_action_ = nullptr;
    QAction* follow_action_ = nullptr;
    QMenu* camera_menu_ = nullptr;
    QElapsedTimer since_refresh_;
    std::optional<MouseHand> mouse_;  ///< mouse-controlled hand of the running session
    /// Why the window closes: as soon as the session has ended, because the user wants it to;
    /// because a signal asked the program to end; or because another program destroyed the window.
    enum class Closing { no, after_session, by_signal, unseen };
    Closing closing_ = Closing::no;
};

}  // namespace dihaptic::gui
