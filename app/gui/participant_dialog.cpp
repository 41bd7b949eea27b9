#include "participant_dialog.h"

#include <QDialogButtonBox>
#include <QFormLayout>
#include <QIntValidator>
#include <QLabel>

#include "session_panel.h"
#include "task/plan/trials.h"

namespace dihaptic::gui {

ParticipantDialog::ParticipantDialog(const recording::Participant& known, bool needs_number,
                                     QWidget* parent)
    : QDialog(parent),
      needs_number_(needs_number),
      id_(new QLineEdit(QString::fromStdString(known.id))),
      age_(new QLineEdit(QString::fromStdString(known.age))),
      sex_(new QComboBox),
      handedness_(new QComboBox) {
    setWindowTitle(tr("Who does the trials?"));
    set_up_identifier(*id_);
    age_->setPlaceholderText(tr("not stated"));
    age_->setValidator(new QIntValidator(0, 150, this));
    sex_->addItem(tr("not stated"), "U");
    for (const char* sex : {"F", "M", "O"}) sex_->addItem(sex, sex);
    sex_->setCurrentIndex(std::max(0, sex_->findData(QString::fromStdString(known.sex))));
    handedness_->addItem(tr("not stated"), "");
    for (const char* hand : {QT_TR_NOOP("right"), QT_TR_NOOP("left"), QT_TR_NOOP("both")})
        handedness_->addItem(tr(hand), hand);
    handedness_->setCurrentIndex(
        std::max(0, handedness_->findData(QString::fromStdString(known.handedness))));

    auto* form = new QFormLayout(this);
    form->addRow(tr("S&ubject"), id_);
    if (needs_number)
        form->addRow(new QLabel(tr("It must end in a number, which orders the trials.")));
    form->addRow(tr("&Age in years"), age_);
    form->addRow(tr("&Sex"), sex_);
    form->addRow(tr("&Handedness"), handedness_);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
    start_ = buttons->addButton(tr("S&tart"), QDialogButtonBox::AcceptRole);
    start_->setDefault(true);
    buttons->button(QDialogButtonBox::Cancel)->setAutoDefault(false);  // Enter must not cancel
    form->addRow(buttons);
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(id_, &QLineEdit::textChanged, this, &ParticipantDialog::check);
    check();
}

recording::Participant ParticipantDialog::participant() const {
    recording::Participant out;
    out.id = id_->text().trimmed().toStdString();
    out.age = age_->text().toStdString();
    out.sex = sex_->currentData().toString().toStdString();
    out.handedness = handedness_->currentData().toString().toStdString();
    return out;
}

void ParticipantDialog::check() {
    start_->setEnabled(!needs_number_ || task::participant_number(participant().id) >= 0);
}

}  // namespace dihaptic::gui
