// The window that a lab sits in front of: the scene, and around it what runs, how it goes, and what
// may be changed.
#pragma once

#include <QElapsedTimer>
#include <QFileSystemWatcher>
#include <QMainWindow>
#include <QTimer>
#include <memory>
#include <optional>

#include "calibrator.h"
#include "device_panel.h"
#include "loader.h"
#include "log_view.h"
#include "participant_dialog.h"
#include "plots_panel.h"
#include "reporter.h"
#include "session_panel.h"
#include "session_runner.h"
#include "subject_window.h"
#include "tuning_panel.h"

namespace dihaptic::gui {

class OperatorWindow : public QMainWindow {
    Q_OBJECT

  public:
    /// `out`: folder for session folders. `sync`: how often a recording is synchronised to the disk
    /// [s]; 0: at its end alone. `stop`: as SessionRunner has it.
    OperatorWindow(QString out, double sync, std::atomic<bool>& stop);
    ~OperatorWindow() override;

    /// A scene or an experiment. What is wrong with it goes to the log, and the last good one
    /// stays.
    void open(const QString& file);
    /// Of the session that runs: in the servo's next tick, and until it is told to go on.
    void force_off();
    /// `signal` asks the program to end, and has ended force already: the window goes, once the
    /// session's files are written.
    void end(int signal);

  protected:
    void closeEvent(QCloseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void make_docks();
    void make_file_menu();
    void make_session_menu();
    /// After the docks, which it lists.
    void make_view_menu();
    void connect_scene();
    void connect_session();
    void connect_tuning();
    void connect_reports();
    /// What is read from files, and read again when they change.
    void connect_files();
    void restore();
    void choose_file();
    void reload();
    void opened(const Opened& opened);
    void refused(const QStringList& problems);
    void start();
    /// Asks for the person first.
    void start_trials();
    /// Offers to go on with a session of that person's that was not finished, if there is one.
    void begin_or_go_on(const recording::Participant& participant);
    /// Reads the file again: the session is of what is shown, and no other. `resumes`: folder of
    /// the session that it goes on with, whose frozen files are read instead; "": none.
    void begin(const recording::Participant& participant, const std::string& resumes = "");
    void run(const experiment::Plan& plan, const recording::Participant& participant);
    /// The rig that is chosen, or the file's.
    void calibrate();
    /// Of the last session.
    void report();
    void stop();
    void skip();
    /// A key that a task may wait for.
    void press(char key);
    /// The workspaces go where the camera is, if they are to follow it.
    void turn_workspaces();
    void pause(bool paused);
    void session_ended(const SessionEnd& end);
    void refresh();
    void show_frame(const servo::Frame& frame);
    void move_hand(double h);
    void show_subject_window(bool shown);
    void show_progress(const servo::Frame& frame);
    bool has_trials() const;
    SessionPanel::State state() const;
    /// What the task tells the person; empty: nothing.
    QString message() const;
    /// Over the scene: what to do next, or what is wrong.
    QString banner() const;
    void update_state();
    void log(const QString& text, bool problem = false);
    experiment::Request request() const;

    QString out_;
    double sync_;
    QString file_;
    std::optional<experiment::Plan> plan_;  ///< of the file as it was last good
    servo::Frame frame_;                    ///< its first
    std::vector<view::Workspace> workspaces_;
    int message_ = -1;                    ///< of the task, that is shown
    recording::Participant participant_;  ///< who did the last trials
    std::optional<MouseHand> mouse_;      ///< of the session that runs
    bool start_when_opened_ = false;
    std::optional<recording::Participant> starts_;  ///< whose session starts when the file is read
    bool changed_ = false;  ///< the file has, while it could not be read again
    bool closing_ = false;
    bool ended_ = false;  ///< by a signal
    bool cut_ = false;    ///< the last session was, and its files were written before that is told

    Loader loader_;
    SessionRunner runner_;
    Calibrator* calibrator_;
    Reporter reporter_;
    SceneWidget* scene_;
    SessionPanel* session_;
    PlotsPanel* plots_;
    DevicePanel* devices_;
    TuningPanel* tuning_;
    LogView* log_;
    std::unique_ptr<SubjectWindow> subject_;
    QAction* open_action_ = nullptr;
    QAction* start_action_ = nullptr;
    QAction* pause_action_ = nullptr;
    QAction* stop_action_ = nullptr;
    QAction* skip_action_ = nullptr;
    QAction* force_off_action_ = nullptr;
    QAction* calibrate_action_ = nullptr;
    QAction* subject_action_ = nullptr;
    QAction* follow_action_ = nullptr;
    QMenu* view_menu_ = nullptr;
    QMenu* camera_menu_ = nullptr;
    QTimer timer_;
    QElapsedTimer since_refresh_;
    QFileSystemWatcher watcher_;
    QTimer reload_;      ///< editors write a file in several goes
    QString recorded_;   ///< folder of the last session; empty: none of this file
    QString complaint_;  ///< about the file as it is now; empty: it is good
};

}  // namespace dihaptic::gui
