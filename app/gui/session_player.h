// A window for a recorded session: the scene at any moment, curves of recorded quantities, and a
// list of events. Two windows may be linked, to compare sessions.
#pragma once

#include <QElapsedTimer>
#include <QMainWindow>
#include <QTimer>
#include <map>
#include <memory>

#include "curve_reader.h"
#include "recording/log_browser.h"
#include "recording/session.h"
#include "task/run/recorded.h"

class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QSlider;
class QTreeWidget;
class QTreeWidgetItem;

namespace dihaptic::gui {

class SceneWidget;
class TimeChart;

class SessionPlayer : public QMainWindow {
    Q_OBJECT

  public:
    /// `folder`: the session's folder. Throws Error when it cannot be read.
    explicit SessionPlayer(const std::string& folder, QWidget* parent = nullptr);
    ~SessionPlayer() override;

    /// The displayed moment [s].
    double time() const { return time_; }
    void go_to(double time);

    /// A moment relative to a trial: the trial's number (0 before the first trial, or without
    /// trials) and the time since it began [s].
    struct Moment {
        int trial = 0;
        double since = 0;
    };
    Moment moment() const;
    /// Shows that moment of the trial's last attempt, at most its end, if this window is linked
    /// with others and has such a trial.
    void follow(const Moment& moment);
    /// Whether this window and others show the same moment.
    void set_together(bool together);

  protected:
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void make_menus();
    QWidget* make_controls();
    void make_moments();
    /// Lists an event at a time [s], unless the time is unmeasured. If the same limit was reached
    /// before, it is only counted.
    void list_moment(double seconds, const QString& what);
    void read_curves();
    /// Shows the curves that the user typed; false, with a message, if one is not an expression.
    bool choose_curves();
    void play(bool on);
    void go_on();
    void step(int frames);
    void next_moment(int way);
    void save_picture();
    void save_video();

    recording::SessionFolder folder_;
    scene::Scene scene_;
    recording::LogBrowser log_;
    double time_ = 0;
    double speed_ = 1;
    std::vector<double> moments_;
    std::map<QString, QTreeWidgetItem*> limits_;
    struct Start {
        double time;  // [s]
        int trial;
    };
    std::vector<Start> starts_;  // starts of attempts at trials
    QAction* together_ = nullptr;
    bool following_ = false;
    std::vector<task::RecordedValue> values_;
    QStringList expressions_{"grip_force", "load_force"};
    CurveReader reader_;
    QTimer timer_;
    QElapsedTimer clock_;
    SceneWidget* view_;
    TimeChart* chart_;
    QSlider* slider_ = nullptr;
    QPushButton* play_ = nullptr;
    QLabel* where_ = nullptr;
    QLineEdit* curves_ = nullptr;
    QTreeWidget* list_ = nullptr;
    QTimer read_;  // delays reading curves after zooming
};

/// Opens a window for each of these sessions. Two windows stand side by side and are linked. Throws
/// Error when one cannot be read.
void open_sessions(const QStringList& folders);

}  // namespace dihaptic::gui
