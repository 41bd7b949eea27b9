#include "sessions_dialog.h"

#include <QDialogButtonBox>
#include <QDir>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <functional>

#include "base/output.h"
#include "base/regular_file.h"
#include "base/shell_word.h"
#include "base/text_file.h"
#include "note_dialog.h"
#include "recording/raw_log.h"
#include "recording/remarks.h"
#include "recording/seal.h"
#include "recording/session.h"
#include "reporter.h"
#include "rows/lift_row.h"
#include "rows/trial_row.h"
#include "session/resume.h"
#include "sign_label.h"

namespace dihaptic::gui {
namespace {

struct SessionColumn {
    enum { started, title, participant, moved_by, state, lasted, trials, lifts, note, folder_name };
};

constexpr int kAdvice = Qt::UserRole + 1;  // role: what to do about a session

constexpr int kLooked = 20;  // number of sessions after which the column widths are adjusted

/// Reads a table of a session and returns what `count` makes of it; "" if the table is missing or
/// damaged.
template <class Row>
QString counted_in(const QString& file, QString (*count)(const rows::RowFile<Row>&)) {
    if (!is_there(file.toStdString())) return "";
    try {
        return count(rows::RowFile<Row>(file.toStdString()));
    } catch (const Error&) {
        return "?";
    }
}

/// The name of an enumerator, in words.
QString in_words(std::string_view name) {
    return QString::fromUtf8(name.data(), static_cast<qsizetype>(name.size())).replace('_', ' ');
}

/// Number of trial attempts in a session, as text.
QString trials_in(const QString& session) {
    if (!QFileInfo::exists(session + "/trial-list.csv")) return "";
    return counted_in<rows::TrialRow>(session + "/trials.csv", [](const rows::TrialFile& trials) {
        return QString::number(trials.size());
    });
}

/// Number of complete lifts and number of all lifts in a session, as text.
QString lifts_in(const QString& session) {
    return counted_in<rows::LiftRow>(session + "/lifts.csv", [](const rows::LiftFile& lifts) {
        return SessionsDialog::tr("%1 of %2")
            .arg(std::ranges::count_if(lifts, &rows::LiftRow::complete))
            .arg(lifts.size());
    });
}

/// Total time of a session's ticks, in minutes and seconds.
QString time_of(const recording::SessionFolder& folder, const recording::SessionInfo& info) {
    if (info.ticks <= 0) return "";
    try {
        const double tick = recording::RawLogReader(folder.raw_log()).head().tick;
        const auto seconds = static_cast<int>(std::lround(info.ticks * tick));
        return QString("%1:%2").arg(seconds / 60).arg(seconds % 60, 2, 10, QChar('0'));
    } catch (const Error&) {
        return "?";
    }
}

/// What to do about a session whose program was killed, or whose disk was full; "" about any other.
QString advice_for(const recording::SessionFolder& folder, const recording::SessionInfo& info) {
    if (info.state != recording::SessionState::running) return "";
    const session::Standing standing = session::standing_of(folder, info);
    if (!standing.killed) return "";
    const QString recover =
        SessionsDialog::tr(
            "This session broke off before its files were written: its program was "
            "killed, or its disk was full. In a terminal, dihaptic recover %1 makes "
            "the files from what was recorded.")
            .arg(QString::fromStdString(shell_file(folder.path())));
    if (standing.trials == 0) return recover;
    return recover + " " +
           SessionsDialog::tr(
               "To do the remaining trials, open its experiment and start it (F5) "
               "with the same participant: the window offers to continue, and makes "
               "the files too.");
}

/// Describes, with remedies, changes made since a session's end to those of its tables that are
/// used in this list.
QString changes_of(const recording::SessionFolder& folder, const recording::SessionInfo& info) {
    constexpr std::string_view kListed[] = {"trials.csv", "lifts.csv"};
    QStringList out;
    for (const Problem& problem : recording::broken_seals(folder, info, Severity::warning, kListed))
        out += QString::fromStdString(problem.text());
    return out.join('\n');
}

/// The note about the session, and those that the operator made while it ran, a line each.
QString notes_of(const QString& session) {
    const std::string file = (session + "/" + kNoteFile).toStdString();
    try {
        QStringList out;
        if (is_there(file)) out += QString::fromStdString(read_text_file(file)).trimmed();
        for (const recording::Remark& remark :
             recording::read_remarks(recording::SessionFolder::open_tables(session.toStdString())))
            out += QString::fromStdString(recording::describe(remark));
        return out.join('\n');
    } catch (const Error&) {
        return "?";
    }
}

}  // namespace

SessionsDialog::SessionsDialog(const QString& folder, QWidget* parent)
    : QDialog(parent),
      where_(new QLabel),
      advice_(new QLabel),
      report_sign_(new SignLabel(this)),
      participant_(new QLineEdit),
      list_(new QTreeWidget),
      folder_(QDir(folder).absolutePath()) {
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("Recorded sessions"));
    list_->setAccessibleName(tr("Sessions"));
    list_->setRootIsDecorated(false);
    list_->setSelectionMode(QAbstractItemView::ExtendedSelection);
    list_->setHeaderLabels({tr("started"), tr("title"), tr("participant"), tr("hand moved by"),
                            tr("state"), tr("duration"), tr("trials"), tr("complete lifts"),
                            tr("note"), tr("folder")});
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Open | QDialogButtonBox::Close);
    auto* layout = new QVBoxLayout(this);
    where_->setWordWrap(true);
    participant_->setPlaceholderText(tr("Only this participant, e.g. S07"));
    participant_->setAccessibleName(tr("Participant"));
    participant_->setClearButtonEnabled(true);
    connect(participant_, &QLineEdit::textChanged, this, [this] {
        for (int i = 0; i < list_->topLevelItemCount(); ++i) filter(*list_->topLevelItem(i));
        show_whether_empty();
    });
    layout->addWidget(where_);
    layout->addWidget(participant_);
    layout->addWidget(list_, 1);
    advice_->setWordWrap(true);
    advice_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    advice_->hide();
    report_sign_->setWordWrap(true);
    layout->addWidget(advice_);
    layout->addWidget(report_sign_);
    layout->addWidget(buttons);
    connect(list_, &QTreeWidget::currentItemChanged, this, &SessionsDialog::show_advice);
    note_ = buttons->addButton(tr("&Note ..."), QDialogButtonBox::ActionRole);
    note_->setAutoDefault(false);
    note_->setToolTip(tr("Kept in the session's folder, and in its report"));
    connect(note_, &QPushButton::clicked, this, &SessionsDialog::write_note);
    report_ = buttons->addButton(tr("&Report"), QDialogButtonBox::ActionRole);
    report_->setAutoDefault(false);
    report_->setToolTip(tr("Draws the session's figures, and shows them in the browser"));
    connect(report_, &QPushButton::clicked, this, [this] {
        if (const QTreeWidgetItem* const item = list_->currentItem())
            Q_EMIT report_requested(item->data(0, Qt::UserRole).toString());
    });
    close_ = buttons->button(QDialogButtonBox::Close);
    open_ = buttons->button(QDialogButtonBox::Open);
    for (QPushButton* button : {open_, note_, report_}) button->setEnabled(false);
    waiting_ =
        QDir(folder).entryInfoList(QDir::Dirs | QDir::NoDotAndDotDot, QDir::Name | QDir::Reversed);
    connect(&filling_, &QTimer::timeout, this, &SessionsDialog::fill_one);
    filling_.start(0);
    connect(buttons, &QDialogButtonBox::accepted, this, &SessionsDialog::choose);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(list_, &QTreeWidget::itemActivated, this, &SessionsDialog::choose);
    resize(1000, 480);
}

void SessionsDialog::embed() {
    setWindowFlags(Qt::Widget);
    close_->hide();
}

void SessionsDialog::follow(const Reporter& reporter) {
    const auto show = [this](const QString& word, const QString& text, Sign sign) {
        report_sign_->set(word, text, sign);
        report_sign_->set_letter(fontInfo().pixelSize());
        report_sign_->show();
    };
    connect(&reporter, &Reporter::told, this, [this, show](const QString& text) {
        show(tr("Report"), text, Sign::busy);
        report_->setEnabled(false);
    });
    if (reporter.busy()) show(tr("Report"), tr("A report is being drawn."), Sign::busy);
    report_->setEnabled(report_->isEnabled() && !reporter.busy());
    connect(&reporter, &Reporter::written, this, [this, show](const QString& page) {
        show(tr("Report"), tr("It is drawn, and shown in the browser: %1").arg(page), Sign::idle);
        report_->setEnabled(true);
    });
    connect(&reporter, &Reporter::failed, this, [this, show](const QString& why) {
        show(tr("There is no report"), why, Sign::fault);
        report_->setEnabled(true);
    });
}

void SessionsDialog::show_advice() {
    const QTreeWidgetItem* const item = list_->currentItem();
    advice_->setText(item == nullptr ? "" : item->data(0, kAdvice).toString());
    advice_->setVisible(!advice_->text().isEmpty());
}

/// Adds the next session to the list. Only one is added per call, because a running session
/// requires a responsive window.
void SessionsDialog::fill_one() {
    if (waiting_.isEmpty()) {
        show_whether_empty();
        return filling_.stop();
    }
    const QFileInfo entry = waiting_.takeFirst();
    const QString path = entry.filePath();
    recording::SessionInfo info;
    QString state = tr("cannot be read"), time, changed, advice;
    try {
        const auto session = recording::SessionFolder::open(path.toStdString());
        info = session.read_info();
        state = in_words(enum_name(info.state));
        advice = advice_for(session, info);
        if (!advice.isEmpty()) state = tr("broken off");
        time = time_of(session, info);
        changed = changes_of(session, info);
        if (!changed.isEmpty()) state += tr(", changed since");
    } catch (const Error&) {
        if (!QFileInfo::exists(path + "/raw.log")) return;  // no session
    }
    auto* item = new QTreeWidgetItem(
        list_, {QString::fromStdString(info.started).left(16).replace('T', ' '),
                QString::fromStdString(info.title), QString::fromStdString(info.participant.id),
                in_words(info.moved_by.name()), state, time, trials_in(path), lifts_in(path),
                notes_of(path), entry.fileName()});
    item->setToolTip(SessionColumn::note, item->text(SessionColumn::note));
    item->setToolTip(SessionColumn::state, advice.isEmpty() ? changed : advice);
    item->setData(0, Qt::UserRole, path);
    item->setData(0, kAdvice, advice);
    for (const int number : {SessionColumn::lasted, SessionColumn::trials, SessionColumn::lifts})
        item->setTextAlignment(number, Qt::AlignRight | Qt::AlignVCenter);
    filter(*item);
    for (QPushButton* button : {open_, note_, report_}) button->setEnabled(true);
    if (list_->topLevelItemCount() <= kLooked || waiting_.isEmpty()) fit_columns();
}

void SessionsDialog::filter(QTreeWidgetItem& item) {
    const bool fits = item.text(SessionColumn::participant)
                          .contains(participant_->text().trimmed(), Qt::CaseInsensitive);
    item.setHidden(!fits);
    if (!fits) {
        item.setSelected(false);  // what is hidden must not be opened
    } else if (list_->selectedItems().isEmpty()) {
        list_->setCurrentItem(&item);
    }
}

void SessionsDialog::show_whether_empty() {
    bool any = false;
    for (int i = 0; i < list_->topLevelItemCount(); ++i) any |= !list_->topLevelItem(i)->isHidden();
    where_->setText(any ? tr("Sessions in %1. Select two (Ctrl + click) to show them side by side.")
                              .arg(folder_)
                    : list_->topLevelItemCount() > 0
                        ? tr("No participant in %1 has \"%2\" in the identifier.")
                              .arg(folder_, participant_->text().trimmed())
                        : tr("There are no sessions in %1 yet. Each session that you start (F5) is "
                             "recorded; File "
                             "> Where sessions go chooses another folder.")
                              .arg(folder_));
}

void SessionsDialog::fit_columns() {
    for (int column = 0; column < list_->columnCount(); ++column) {
        bool says = false;
        for (int i = 0; i < list_->topLevelItemCount(); ++i)
            says |= !list_->topLevelItem(i)->text(column).isEmpty();
        list_->setColumnHidden(column, !says);  // e.g. lifts, where nobody lifts
        list_->resizeColumnToContents(column);
    }
    list_->setColumnWidth(SessionColumn::note,
                          std::min(250, list_->columnWidth(SessionColumn::note)));
}

void SessionsDialog::write_note() {
    QTreeWidgetItem* const item = list_->currentItem();
    if (item == nullptr) return;
    const QString session = item->data(0, Qt::UserRole).toString();
    const std::string file = (session + "/" + kNoteFile).toStdString();
    try {
        // checked before the user writes a note in vain or sees a foreign file as a note
        check_replaceable(file);
        // read again, because the note may have changed since the list was filled
        const std::string before = is_there(file) ? read_text_file(file) : "";
        const auto note = ask_for_note(item->text(SessionColumn::folder_name),
                                       QString::fromStdString(before).trimmed(), this);
        if (!note) return;
        write_file(note->trimmed().toStdString() + "\n", file);
    } catch (const Error& e) {
        QMessageBox::warning(this, tr("Note"), QString::fromStdString(e.problems().front().text()));
    }
    item->setText(SessionColumn::note, notes_of(session));
    item->setToolTip(SessionColumn::note, item->text(SessionColumn::note));
    fit_columns();
}

void SessionsDialog::choose() {
    QStringList folders;
    for (const QTreeWidgetItem* item : list_->selectedItems())
        folders += item->data(0, Qt::UserRole).toString();
    if (folders.isEmpty()) return;
    Q_EMIT chosen(folders);
    accept();
}

}  // namespace dihaptic::gui
