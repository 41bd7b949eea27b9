// The panel in which a session is set up, started, paused and stopped, and which shows its
// progress.
#pragma once

#include <QBoxLayout>
#include <QComboBox>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>

#include "session_control.h"
#include "sign_label.h"
#include "trial_strip.h"

namespace dihaptic::gui {

/// Restricts a text field to characters that are allowed in folder names.
void set_up_identifier(QLineEdit& field);

class SessionPanel : public QWidget {
    Q_OBJECT

  public:
    explicit SessionPanel(SessionControl& control);

    /// Sets the available rig files; the first choice is always the rig named in the open file.
    void set_rigs(const QStringList& files);
    QString rig() const { return rig_->currentData().toString(); }
    /// The participant of a scene, or the simulated person; before trials by anyone else, the
    /// window asks.
    QString participant() const { return participant_->text().trimmed(); }
    enum class Hand { mouse, script, person };
    Hand hand() const { return static_cast<Hand>(hand_->currentIndex()); }
    /// Ratio of session time to wall time; 0 for as fast as the machine allows. It is 1 if the
    /// mouse moves the hand.
    double pace() const;
    /// Gives the keyboard to the field for a note on the running trial.
    void write_note();

  Q_SIGNALS:
    void open_requested();
    /// A different rig or hand was chosen.
    void choice_changed();
    void start_requested();
    void report_requested();
    void note_written();

  protected:
    void resizeEvent(QResizeEvent* event) override;

  private:
    void set_up_hand();
    /// Gives the line below the trial as many lines as its words need.
    void fit_names();
    void connect_control();
    void show_state();
    void show_sign();
    void show_pace();
    /// Shows what the open file is, until its session runs.
    void show_title();
    void set_progress(double share, const QString& text);
    /// Shows the running trial; empty texts if there is none.
    void set_trial(const QString& number, const QString& names);
    void store_note();
    void make_form();
    void make_buttons();

    SessionControl& control_;
    SignLabel* sign_;
    QFormLayout* form_;
    QHBoxLayout* file_row_;
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
    QPushButton* report_;
    QLabel* trial_;
    QLabel* names_;
    QProgressBar* progress_;
    TrialStrip* strip_;
    QLineEdit* note_;
};

}  // namespace dihaptic::gui
