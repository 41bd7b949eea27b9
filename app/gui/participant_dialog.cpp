#include "participant_dialog.h"

#include <QDateTime>
#include <QDialogButtonBox>
#include <QHeaderView>
#include <QIntValidator>
#include <QLocale>
#include <QVBoxLayout>
#include <utility>

#include "identifiers.h"

namespace dihaptic::gui {
namespace {

constexpr int kWidth = 80;  // of the dialog, in characters: room for the list's columns

/// The day and time of a session's start, in the reader's time zone.
QString moment(const std::string& started) {
    const QDateTime time = QDateTime::fromString(QString::fromStdString(started), Qt::ISODate);
    return QLocale().toString(time.toLocalTime(), "d MMMM, HH:mm");
}

}  // namespace

ParticipantDialog::ParticipantDialog(KnownPeople known, bool needs_number, QWidget* parent)
    : QDialog(parent),
      known_(std::move(known)),
      needs_number_(needs_number),
      id_(new QLineEdit),
      next_(new QPushButton),
      says_(new QLabel),
      sure_(new QCheckBox),
      other_(new QPushButton),
      age_(new QLineEdit),
      sex_(new QComboBox),
      handedness_(new QComboBox),
      list_(new QTreeWidget) {
    setWindowTitle(tr("Who does the trials?"));
    setMinimumWidth(kWidth * fontMetrics().averageCharWidth());
    auto* form = new QFormLayout;
    make_identifier(form);
    make_facts(form);
    make_list();

    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
    start_ = buttons->addButton(tr("S&tart"), QDialogButtonBox::AcceptRole);
    start_->setDefault(true);
    QPushButton* cancel = buttons->button(QDialogButtonBox::Cancel);
    for (QPushButton* button : {cancel, next_, other_})
        button->setAutoDefault(false);  // Enter starts, and does nothing else
    auto* layout = new QVBoxLayout(this);
    layout->addLayout(form);
    layout->addWidget(list_, 1);
    layout->addWidget(buttons);
    QWidget* before = id_;
    for (QWidget* widget : std::initializer_list<QWidget*>{sure_, other_, age_, sex_, handedness_,
                                                           start_, cancel, next_, list_}) {
        setTabOrder(before, widget);
        before = widget;
    }
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(sure_, &QCheckBox::toggled, start_, &QWidget::setEnabled);
    check();
    id_->setFocus();
}

void ParticipantDialog::make_identifier(QFormLayout* form) {
    id_->setPlaceholderText(tr("e.g. S07"));
    const QString next = QString::fromStdString(next_identifier(known_.identifiers()));
    next_->setText(tr("&New: %1").arg(next));
    says_->setWordWrap(true);
    says_->setTextFormat(Qt::PlainText);
    says_->setMinimumHeight(3 * fontMetrics().lineSpacing());  // so that little moves while typing
    says_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
    auto* row = new QHBoxLayout;
    row->addWidget(id_, 1);
    row->addWidget(next_);
    auto* label = new QLabel(tr("&Participant"));
    label->setBuddy(id_);
    form->addRow(label, row);
    form->addRow("", says_);
    auto* answer = new QHBoxLayout;
    answer->addWidget(sure_, 1);
    answer->addWidget(other_);
    form->addRow("", answer);
    connect(next_, &QPushButton::clicked, this, [this, next] { id_->setText(next); });
    connect(other_, &QPushButton::clicked, this,
            [this] { id_->setText(other_->property("id").toString()); });
    connect(id_, &QLineEdit::textChanged, this, &ParticipantDialog::check);
    connect(id_, &QLineEdit::returnPressed, this, [this] {
        if (!sure_->isHidden() && !sure_->isChecked()) sure_->setFocus();
    });
}

void ParticipantDialog::make_facts(QFormLayout* form) {
    age_->setPlaceholderText(tr("not stated"));
    age_->setValidator(new QIntValidator(0, 150, this));
    sex_->addItem(tr("not stated"), "U");
    for (const char* sex : {"F", "M", "O"}) sex_->addItem(sex, sex);
    handedness_->addItem(tr("not stated"), "");
    for (const char* hand : {QT_TR_NOOP("right"), QT_TR_NOOP("left"), QT_TR_NOOP("both")})
        handedness_->addItem(tr(hand), hand);
    form->addRow(tr("&Age in years"), age_);
    form->addRow(tr("&Sex"), sex_);
    form->addRow(tr("&Handedness"), handedness_);
}

void ParticipantDialog::make_list() {
    list_->setAccessibleName(tr("People who are known"));
    list_->setRootIsDecorated(false);
    list_->setUniformRowHeights(true);
    list_->setHeaderLabels(
        {tr("known"), tr("last session"), tr("experiment"), tr("group"), tr("next in the study")});
    for (const KnownPerson& known : known_.people()) {
        const auto text = [](const std::string& word) { return QString::fromStdString(word); };
        new QTreeWidgetItem(list_, {text(known.participant.id),
                                    known.last.empty() ? tr("none yet") : moment(known.last),
                                    text(known.title), text(known.group), text(known.day)});
    }
    for (int column = 0; column < list_->columnCount(); ++column)
        list_->resizeColumnToContents(column);
    for (const int column : {3, 4}) list_->setColumnHidden(column, known_.study().empty());
    list_->setVisible(!known_.people().empty());
    list_->setMinimumHeight(6 * fontMetrics().lineSpacing());
    const auto take = [this](QTreeWidgetItem* item) { id_->setText(item->text(0)); };
    connect(list_, &QTreeWidget::itemClicked, this, take);
    connect(list_, &QTreeWidget::itemActivated, this, take);
}

recording::Participant ParticipantDialog::participant() const {
    recording::Participant out;
    out.id = id_->text().trimmed().toStdString();
    out.age = age_->text().toStdString();
    out.sex = sex_->currentData().toString().toStdString();
    out.handedness = handedness_->currentData().toString().toStdString();
    return out;
}

ParticipantDialog::Verdict ParticipantDialog::verdict(const std::string& id) const {
    const std::vector<std::string> all = known_.identifiers();
    const QString typed = QString::fromStdString(id);
    if (const QString fault = fault_of_identifier(id, needs_number_); !fault.isEmpty())
        return {fault, "", "", false};
    if (const KnownPerson* person = known_.find(id)) {
        const bool returns = !person->last.empty();
        return {describe(*person), returns ? tr("&Yes, this is the same %1").arg(typed) : "", "",
                true};
    }
    const QString next = QString::fromStdString(next_identifier(all));
    const QString is_new = tr("&Yes, %1 is a new person").arg(typed);
    if (!known_.study().empty())
        return {tr("%1 has not been added to the study.").arg(typed), is_new,
                QString::fromStdString(resembled(id, all)), true};
    if (typed == next) return {tr("%1 is new.").arg(typed), "", "", true};
    const QString like = QString::fromStdString(resembled(id, all));
    if (!like.isEmpty())
        return {tr("%1 is new, but resembles %2.").arg(typed, like), is_new, like, true};
    if (out_of_turn(id, all))
        return {tr("%1 is new, but the next number is %2.").arg(typed, next), is_new, "", true};
    return {tr("%1 is new.").arg(typed), "", "", true};
}

QString ParticipantDialog::describe(const KnownPerson& person) const {
    const QString id = QString::fromStdString(person.participant.id);
    if (person.last.empty()) return tr("%1 is in the study, and has had no session.").arg(id);
    QString out = tr("%1 is known: last recorded on %2, in %3.")
                      .arg(id, moment(person.last), QString::fromStdString(person.title));
    if (const auto unfinished = known_.unfinished(person.participant.id)) {
        out += "\n" + (unfinished->done == 0
                           ? tr("A session of this experiment is unfinished.")
                           : tr("A session of this experiment is unfinished: %1 of %2 trials.")
                                 .arg(unfinished->done)
                                 .arg(unfinished->trials));
    } else if (person.complete) {
        out += "\n" + tr("This experiment has already been completed.");
    }
    return out;
}

void ParticipantDialog::check() {
    const std::string id = participant().id;
    const Verdict found = verdict(id);
    says_->setText(found.says);
    sure_->setText(found.question);
    sure_->setChecked(false);
    sure_->setVisible(!found.question.isEmpty());
    other_->setText(tr("I &meant %1").arg(found.resembles));
    other_->setProperty("id", found.resembles);
    other_->setVisible(!found.resembles.isEmpty());
    start_->setEnabled(found.valid && found.question.isEmpty());
    const KnownPerson* const person = known_.find(id);
    if (person != nullptr) {
        show_facts(person->participant);
    } else if (!facts_of_.empty()) {
        show_facts({});  // those of the person whose identifier was typed before
    }
    facts_of_ = person == nullptr ? "" : id;
    list_->clearSelection();
    for (QTreeWidgetItem* item : list_->findItems(QString::fromStdString(id), Qt::MatchExactly))
        item->setSelected(true);
}

void ParticipantDialog::show_facts(const recording::Participant& of) {
    age_->setText(QString::fromStdString(of.age));
    sex_->setCurrentIndex(std::max(0, sex_->findData(QString::fromStdString(of.sex))));
    handedness_->setCurrentIndex(
        std::max(0, handedness_->findData(QString::fromStdString(of.handedness))));
}

void ParticipantDialog::accept() {
    if (start_->isEnabled()) QDialog::accept();
}

}  // namespace dihaptic::gui
