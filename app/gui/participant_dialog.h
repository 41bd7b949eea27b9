// The dialog that asks for the participant's data before a session with trials. It starts a session
// only for a valid identifier, and only after a question if the person is known, or if the
// identifier could be a slip of the keyboard: data recorded under a wrong name cannot be recovered.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>

#include "known_people.h"

namespace dihaptic::gui {

class ParticipantDialog : public QDialog {
    Q_OBJECT

  public:
    /// `needs_number`: whether the order of the trials depends on the number at the end of the
    /// identifier.
    ParticipantDialog(KnownPeople known, bool needs_number, QWidget* parent);
    recording::Participant participant() const;
    void accept() override;

  private:
    void make_identifier(QFormLayout* form);
    void make_facts(QFormLayout* form);
    void make_list();
    /// What an identifier means.
    struct Verdict {
        QString says;      ///< a fault, or what is known of the person
        QString question;  ///< to be answered before anything is recorded; "" if there is none
        QString
            resembles;  ///< the known identifier for which it may be a slip; "" if there is none
        bool valid;
    };
    Verdict verdict(const std::string& id) const;
    void check();
    /// What is known of a person.
    QString describe(const KnownPerson& person) const;
    void show_facts(const recording::Participant& of);

    KnownPeople known_;
    bool needs_number_;
    QLineEdit* id_;
    QPushButton* next_;
    QLabel* says_;
    QCheckBox* sure_;
    QPushButton* other_;  ///< takes the known identifier that the typed one resembles
    QLineEdit* age_;
    QComboBox* sex_;
    QComboBox* handedness_;
    QTreeWidget* list_;
    QPushButton* start_ = nullptr;
    std::string facts_of_;  ///< the known person whose facts are shown; "" if they were typed
};

}  // namespace dihaptic::gui
