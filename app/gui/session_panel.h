// The panel that selects, starts, pauses and stops a session, and shows its progress.
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>

#include "session_control.h"

namespace dihaptic::gui {

/// Limits a field to characters that may be part of a folder's name.
void set_up_identifier(QLineEdit& field);

class SessionPanel : public QWidget {
    Q_OBJECT

  public:
    explicit SessionPanel(SessionControl& control);

    /// The available rig files; the first choice is the rig named in the file.
    void set_rigs(const QStringList& files);
    QString rig() const { return rig_->currentData().toString(); }
    QString participant() const { return participant_->text().trimmed(); }
    void set_participant(const QString& id) { participant_->setText(id); }
    enum class Hand { mouse, script, person };
    Hand hand() const { return static_cast<Hand>(hand_->currentIndex()); }
    /// Session time over wall time; 0: as fast as the machine allows. With the mouse it is 1.
    double pace() const;

  Q_SIGNALS:
    void open_requested();
    /// Another rig or another hand was chosen.
    void choice_changed();
    void start_requested();

  private:
    void set_up_hand();
    void connect_control();
    void show_state();
    void set_progress(double share, const QString& text);
    /// `text`: the running trial; empty: none.
    void set_trial(const QString& text);

    SessionControl& control_;
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
