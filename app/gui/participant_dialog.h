// The dialog that asks for the participant's data before a session with trials.
#pragma once

#include <QComboBox>
#include <QDialog>
#include <QLineEdit>
#include <QPushButton>

#include "recording/session.h"

namespace dihaptic::gui {

class ParticipantDialog : public QDialog {
    Q_OBJECT

  public:
    /// `known`: initial contents of the fields. `needs_number`: whether the order of the trials
    /// depends on the number at the end of the identifier.
    ParticipantDialog(const recording::Participant& known, bool needs_number, QWidget* parent);
    recording::Participant participant() const;

  private:
    void check();

    bool needs_number_;
    QLineEdit* id_;
    QLineEdit* age_;
    QComboBox* sex_;
    QComboBox* handedness_;
    QPushButton* start_ = nullptr;
};

}  // namespace dihaptic::gui
