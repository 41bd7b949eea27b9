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
    /// `out`: folder for session folders.
    explicit OperatorWindow(QString out);
    ~OperatorWindow() override;

    /// A scene or an experiment. What is wrong with it goes to the log, and the last good one
    /// stays.
    void open(const QString& file);

  protected:
    void closeEvent(QCloseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void make_docks();
    void make_menus();
    void restore();
    void choose_file();
    void reload();
    void opened(const Opened& opened);
    void refused(const QStringList& problems);
    void start();
    /// Asks for the person first.
    void start_trials();
    void begin(const recording::Participant& participant);
    void run(experiment::Plan plan, const recording::Participant& participant);
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
    void force_off();
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
    QString file_;
    std::optional<experiment::Plan> plan_;  ///< of the file as it was last good
    servo::Frame frame_;                    ///< its first
    int message_ = -1;                      ///< of the task, that is shown
    recording::Participant participant_;    ///< who did the last trials
    std::optional<MouseHand> mouse_;        ///< of the session that runs
    bool start_when_opened_ = false;
    bool closing_ = false;

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
