// Chooses what runs, and starts, pauses and stops it.
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>

#include "experiment/plan.h"

namespace dihaptic::gui {

class SessionPanel : public QWidget {
    Q_OBJECT

  public:
    enum class State { nothing, ready, running, paused, finishing };

    explicit SessionPanel(QWidget* parent = nullptr);

    void set_file(const QString& file);
    /// Rig files to choose from; the first choice is what the file says.
    void set_rigs(const QStringList& files);
    void set_state(State state);
    /// `now`, `end` in session time [s]; an end that never comes is no number.
    void set_progress(double now, double end, const QString& phase);
    void set_finishing(double share);

    QString rig() const { return rig_->currentData().toString(); }
    QString participant() const { return participant_->text().trimmed(); }
    bool by_mouse() const { return hand_->currentIndex() == 0; }

  Q_SIGNALS:
    void open_requested();
    /// Another rig, or another hand.
    void choice_changed();
    void start_requested();
    void pause_requested(bool paused);
    void stop_requested();

  private:
    QLabel* file_;
    QComboBox* rig_;
    QLineEdit* participant_;
    QComboBox* hand_;
    QPushButton* open_;
    QPushButton* start_;
    QPushButton* pause_;
    QPushButton* stop_;
    QProgressBar* progress_;
};

}  // namespace dihaptic::gui
