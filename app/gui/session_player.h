// A window for a recorded session: the scene at any time, curves of recorded quantities, and a list
// of events. Two windows can be linked to compare sessions.
#pragma once

#include <QMainWindow>
#include <QTimer>
#include <memory>

#include "curve_reader.h"
#include "playback.h"
#include "recording/log_browser.h"
#include "recording/session.h"
#include "task/run/recorded.h"

class QComboBox;
class QLabel;
class QPushButton;
class QSlider;

namespace dihaptic::gui {

class CurveList;
class MomentList;
class SceneWidget;
class TimeChart;

class SessionPlayer : public QMainWindow {
    Q_OBJECT

  public:
    /// `folder`: the folder of the session. Throws Error when the session cannot be read.
    explicit SessionPlayer(const std::string& folder, QWidget* parent = nullptr);
    ~SessionPlayer() override;

    /// The displayed time [s].
    double time() const { return time_; }
    void go_to(double time);

    /// A time relative to a trial: the trial's number (0 before the first trial, or without trials)
    /// and the time since the trial began [s].
    struct Moment {
        int trial = 0;
        double since = 0;
    };
    Moment moment() const;
    /// If this window is linked with others and its session has the trial, shows the given moment
    /// of the trial's last attempt, but no later than the attempt's end.
    void follow(const Moment& moment);
    /// Sets whether this window and others show the same moment.
    void set_together(bool together);

  protected:
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void make_menus();
    void make_file_menu();
    QWidget* make_controls();
    void make_moments();
    void list_trials();
    void make_curve_list();
    void read_curves();
    /// Shows these curves. If one of them is not a valid expression, shows a message instead.
    void choose_curves(const QStringList& expressions);
    void save_curves();
    void play(bool on);
    void go_on(double passed);
    void step(int frames);
    void next_moment(int way);
    QString own_name(const QString& what) const;
    void save_picture();
    void save_video();

    recording::SessionFolder folder_;
    scene::Scene scene_;
    recording::LogBrowser log_;
    double time_ = 0;
    struct Start {
        double time;  // [s]
        int trial;
    };
    std::vector<Start> starts_;  // start of each trial attempt
    QAction* together_ = nullptr;
    QAction* choose_ = nullptr;  // moves to the list of curves
    bool following_ = false;
    std::vector<task::RecordedValue> values_;
    QStringList expressions_;
    CurveReader reader_;
    Playback playback_{[this](double passed) { go_on(passed); }};
    SceneWidget* view_;
    TimeChart* chart_;
    QSlider* slider_ = nullptr;
    QPushButton* play_ = nullptr;
    QLabel* where_ = nullptr;
    MomentList* moments_;
    CurveList* curves_;
    QTimer read_;  // delays the reading of curves after zooming
};

/// Opens a window for each of these sessions. Two windows are placed side by side and linked.
/// Throws Error when a session cannot be read.
void open_sessions(const QStringList& folders);

}  // namespace dihaptic::gui
