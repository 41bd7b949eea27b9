// The panel that selects, starts, pauses and stops a session.
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>

#include "session/plan.h"

namespace dihaptic::gui {

/// Limits a field to characters that may be part of a folder's name.
void set_up_identifier(QLineEdit& field);

class SessionPanel : public QWidget {
    Q_OBJECT

  public:
    enum class State { nothing, opening, ready, running, paused, finishing };

    explicit SessionPanel(QWidget* parent = nullptr);

    void set_file(const QString& file);
    /// The available rig files; the first choice is the rig named in the file.
    void set_rigs(const QStringList& files);
    /// `trials`: whether the running or selected file has trials.
    void set_state(State state, bool trials);
    void set_progress(double share, const QString& text);
    /// `text`: the running trial; empty: none.
    void set_trial(const QString& text);
    void set_finishing(double share);

    QString rig() const { return rig_->currentData().toString(); }
    QString participant() const { return participant_->text().trimmed(); }
    void set_participant(const QString& id) { participant_->setText(id); }
    enum class Hand { mouse, script, person };
    Hand hand() const { return static_cast<Hand>(hand_->currentIndex()); }
    /// Session time over time; 0: as fast as the machine allows. With the mouse it is 1.
    double pace() const;

  Q_SIGNALS:
    void open_requested();
    /// Another rig or another hand was chosen.
    void choice_changed();
    void pace_changed(double pace);
    void start_requested();
    void pause_requested(bool paused);
    void skip_requested();
    /// The session, or the opening of a file, should stop.
    void stop_requested();

  private:
    void set_up_hand();

    QLabel* file_;
    QComboBox* rig_;
    QLineEdit* participant_;
    QComboBox* hand_;
    QComboBox* pace_;
    QPushButton* open_;
    QPushButton* start_;
    QPushButton* pause_;
    QPushButton* skip_;
    QPushButton* stop_;
    QLabel* trial_;
    QProgressBar* progress_;
};

}  // namespace dihaptic::gui
