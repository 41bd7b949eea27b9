#include "composer.h"

#include <QFileInfo>
#include <QLocale>
#include <QMessageBox>
#include <QRegularExpression>
#include <QTimer>
#include <QVBoxLayout>

#include "base/regular_file.h"
#include "base/text.h"
#include "base/text_file.h"
#include "save_dialog.h"
#include "scene/body_text.h"

namespace dihaptic::gui {
namespace {

constexpr int kPause = 400;  // [ms]
constexpr int kLook = 100;   // [ms]
constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";

/// Whether an editor can show the bytes of a file as text and write them back unchanged.
bool is_text(const QByteArray& content) {
    QByteArray text = content;
    if (text.startsWith(kByteOrderMark)) text.remove(0, 3);
    text.replace("\r\n", "\n");
    return !find_fault(text.toStdString());
}

/// Whether a window that ended without saving left text for the file, which may be missing since.
bool has_draft_left(const QString& file) {
    try {
        Draft draft(EditedFile(file).path());
        return draft.take() && draft.left();
    } catch (const Error&) {
        return false;
    }
}

/// The line of a text, counted from 1, that contains the byte at position `at`.
int line_of(const QByteArray& text, size_t at) {
    return 1 + static_cast<int>(text.left(static_cast<qsizetype>(at)).count('\n'));
}

}  // namespace

Composer::Composer(QWidget* parent)
    : QWidget(parent),
      edit_(new CodeEdit),
      find_(new FindBar(*edit_)),
      state_(new QLabel),
      save_(new QPushButton(tr("Save"))) {
    edit_->setAccessibleName(tr("File's text"));
    state_->setWordWrap(true);
    state_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    save_->setToolTip("Ctrl+S");
    save_->setEnabled(false);
    auto* below = new QHBoxLayout;
    below->addWidget(state_, 1);
    below->addWidget(save_);
    auto* layout = new QVBoxLayout(this);
    layout->addWidget(edit_, 1);
    layout->addWidget(find_);
    layout->addLayout(below);
    pause_.setSingleShot(true);
    pause_.setInterval(kPause);
    // also when the text becomes that of the file again, as by undoing
    connect(edit_, &QPlainTextEdit::textChanged, &pause_, qOverload<>(&QTimer::start));
    connect(edit_->document(), &QTextDocument::modificationChanged, this, [this](bool changed) {
        save_->setEnabled(changed);
        if (!changed) drop_draft();
        Q_EMIT modified(changed);
    });
    connect(&pause_, &QTimer::timeout, this, &Composer::check);
    look_.setSingleShot(true);
    look_.setInterval(kLook);
    connect(edit_, &QPlainTextEdit::cursorPositionChanged, &look_, qOverload<>(&QTimer::start));
    connect(edit_, &QPlainTextEdit::textChanged, &look_, qOverload<>(&QTimer::start));
    connect(&look_, &QTimer::timeout, this, &Composer::cursor_moved);
    connect(edit_, &QPlainTextEdit::undoAvailable, this, &Composer::undo_available);
    connect(edit_, &QPlainTextEdit::redoAvailable, this, &Composer::redo_available);
    connect(edit_, &CodeEdit::step_wanted, this, &Composer::step_wanted);
    connect(edit_, &CodeEdit::words_wanted, this,
            [this](const WordPlace& place) { finder_.find(file_.name(), place); });
    connect(&finder_, &WordFinder::found, edit_, &CodeEdit::offer);
    connect(save_, &QPushButton::clicked, this, &Composer::save);
}

Composer::~Composer() {
    if (!leaves_) end_draft();
}

void Composer::forget() {
    end_draft();
    file_ = {};
    edit_->document()->setModified(false);
}

QString Composer::why_not_to_open(const QString& file) {
    if (!QFileInfo::exists(file) && has_draft_left(file)) return "";
    if (!QFileInfo::exists(file))
        return tr("%1 does not exist. If it was moved, open it where it is now.").arg(file);
    try {
        if (is_text(QByteArray::fromStdString(read_bytes(file.toStdString(), kMostYaml))))
            return "";
    } catch (const Error& e) {
        return QString::fromStdString(e.problems().front().text());
    }
    return tr("%1 is not UTF-8 text, or contains control characters: it is no scene or experiment. "
              "Open another file.")
        .arg(file);
}

void Composer::open(const QString& file) {
    if (file == file_.name()) return look_again();
    read_file(file);
}

void Composer::read_file(const QString& name) {
    if (name != file_.name() || file_.leads_elsewhere()) end_draft();
    file_ = EditedFile(name);
    show_content();
    note("");
    if (!draft_) begin_draft();
}

void Composer::show_content() {
    const QByteArray content = file_.content();
    const bool text = is_text(content);
    edit_->setPlainText(text ? QString::fromUtf8(content) : "");
    edit_->document()->setModified(false);
    pause_.stop();  // this text was not typed by the user
    edit_->setReadOnly(!text || !file_.was_readable() || !QFileInfo(file_.name()).isWritable());
}

void Composer::look_again() {
    if (!file_.leads_elsewhere() && !file_.has_changed()) {
        if (content() == file_.content()) edit_->document()->setModified(false);
        return note("");
    }
    const bool mine = changed() && content() != file_.content();
    const bool readable = file_.is_readable();
    if (readable && mine)
        return note(tr("%1 was changed by another program after it was read here. Ctrl+S asks "
                       "which version to keep.")
                        .arg(file_.name()));
    if (readable || !file_.was_readable() || !is_text(file_.content()))
        return read_file(QString(file_.name()));
    edit_->setReadOnly(false);
    edit_->document()->setModified(true);
    note(tr("%1 no longer exists, or cannot be read. Its text is kept here: Ctrl+S writes it "
            "again.")
             .arg(file_.name()));
}

void Composer::begin_draft() {
    draft_.emplace(file_.path());
    try {
        has_draft_ = draft_->take();
    } catch (const Error& e) {
        draft_.reset();
        return note(tr("Unsaved text would be lost in a crash: %1").arg(e.what()));
    }
    note(note_);
    const auto left = has_draft_ ? draft_->left() : std::nullopt;
    if (!left) return;
    if (left->text == edit_->text()) return draft_->remove();
    offer(*left);
}

void Composer::offer(const Draft::Left& left) {
    offer_ = new QMessageBox(this);
    offer_->setAttribute(Qt::WA_DeleteOnClose);
    offer_->setWindowTitle(tr("Unsaved text"));
    offer_->setText(tr("A window that ended without saving left text for %1, from %2.\n\nContinue "
                       "with it? The file stays unchanged until you save.")
                        .arg(file_.name(), QLocale().toString(left.at, "d MMMM, HH:mm")));
    auto* go_on = offer_->addButton(tr("&Continue with it"), QMessageBox::AcceptRole);
    auto* discard = offer_->addButton(tr("&Discard it"), QMessageBox::DestructiveRole);
    offer_->setDefaultButton(go_on);
    offer_->setEscapeButton(go_on);  // continuing with the text loses nothing
    connect(offer_, &QDialog::finished, this, [this, discard, text = left.text] {
        const bool discarded = offer_->clickedButton() == discard;
        offer_ = nullptr;
        if (discarded) return draft_->remove();
        take(text);
    });
    offer_->open();
}

/// Replaces the text in an undoable step; undoing it restores the file's contents.
void Composer::take(const QString& text) {
    edit_->setReadOnly(false);
    QTextCursor cursor(edit_->document());
    cursor.select(QTextCursor::Document);
    cursor.insertText(text);
    Q_EMIT draft_taken();
    check();
}

void Composer::check() {
    keep_draft();
    Q_EMIT edited();
}

void Composer::keep_draft() {
    if (!draft_ || offer_ || !changed()) return;
    // the window that held the draft may have closed, so its text must be offered first
    if (!has_draft_) begin_draft();
    if (!has_draft_ || offer_) return;
    try {
        draft_->write(edit_->text());
    } catch (const Error& e) {
        note(tr("Unsaved text would be lost in a crash: %1").arg(e.what()));
    }
}

void Composer::drop_draft() {
    if (has_draft_ && !offer_) draft_->remove();
}

void Composer::end_draft() {
    drop_draft();
    delete offer_;  // the draft that was offered is kept
    draft_.reset();
    has_draft_ = false;
}

bool Composer::leave_draft() {
    keep_draft();
    return leaves_ = has_draft_;
}

QByteArray Composer::content() const {
    QString text = edit_->text();
    if (file_.content().contains("\r\n")) text.replace("\n", "\r\n");
    return (file_.content().startsWith(kByteOrderMark) ? kByteOrderMark : "") + text.toUtf8();
}

std::optional<std::string> Composer::unsaved() const {
    return changed() ? std::optional(edit_->text().toStdString()) : std::nullopt;
}

bool Composer::go_to(const Place& place) {
    const QString file = QString::fromStdString(place.file);
    if (place.line < 1 || file != file_.name()) return false;
    edit_->go_to(place.line);
    return true;
}

std::string Composer::body() const {
    const QString text = edit_->text();
    const QByteArray before = text.left(edit_->textCursor().position()).toUtf8();
    return scene::body_at(text.toStdString(), static_cast<size_t>(before.size()));
}

bool Composer::move(const std::string& body, const BodyWay& way) {
    if (edit_->isReadOnly()) return false;  // a note that says so is always shown
    if (body.empty()) {
        state_->setText(tr("The cursor is not in the lines of a body: nothing moves."));
        return false;
    }
    try {
        edit_->change(scene::moved_body(edit_->text().toStdString(), body, way.way, way.turn));
        show_state();
        return true;
    } catch (const Error& e) {
        state_->setText(e.what());
        return false;
    }
}

bool Composer::save() {
    if (!changed()) return true;
    if (!may_write()) return false;
    try {
        file_.write(content());
    } catch (const Error& e) {
        return refuse(e.what());
    }
    pause_.stop();
    edit_->document()->setModified(false);
    note("");
    Q_EMIT saved();
    return true;
}

bool Composer::is_writable_text() {
    const QByteArray text = edit_->text().toUtf8();
    const auto fault = find_fault(text.toStdString());
    if (!fault) return true;
    const int line = line_of(text, fault->at);
    edit_->go_to(line);
    return refuse(tr("line %1: %2. Nothing was written.")
                      .arg(QString::number(line), QString::fromStdString(fault->what)));
}

bool Composer::may_write() {
    if (!is_writable_text()) return false;
    if (file_.leads_elsewhere())
        return refuse(tr("%1 has become a link, or leads elsewhere than when it was opened: "
                         "nothing was written. Save the text under another name (Ctrl+Shift+S).")
                          .arg(file_.name()));
    if (!may_replace(file_.path(), {ending_of(file_.path())})) return false;
    return !file_.is_there() || !file_.has_changed() || may_overwrite();
}

/// The files of a recorded session stay as they were recorded.
bool Composer::may_replace(const QString& file, const QStringList& endings) {
    const QString why = QFileInfo::exists(file) ? why_not_to_write(file, endings) : "";
    return why.isEmpty() || refuse(why);
}

bool Composer::may_overwrite() {
    QMessageBox box(QMessageBox::Warning, tr("Overwrite?"),
                    tr("%1 was changed by another program after it was read here. Overwrite its "
                       "version with this text?")
                        .arg(file_.name()),
                    QMessageBox::NoButton, this);
    auto* overwrite = box.addButton(tr("&Overwrite"), QMessageBox::DestructiveRole);
    auto* another = box.addButton(tr("Save &As ..."), QMessageBox::AcceptRole);
    box.setDefaultButton(box.addButton(QMessageBox::Cancel));
    box.exec();
    if (box.clickedButton() == another) QTimer::singleShot(0, this, &Composer::save_as_wanted);
    return box.clickedButton() == overwrite ||
           refuse(tr("Not saved: %1 was changed by another program. Save the text under another "
                     "name (Ctrl+Shift+S), or open the file again to read its present content.")
                      .arg(file_.name()));
}

bool Composer::save_as(const QString& file) {
    if (!is_writable_text() || !may_replace(file, {".yaml", ".yml"})) return false;
    try {
        replace_file(file, content());
    } catch (const Error& e) {
        return refuse(e.what());
    }
    forget();
    return true;
}

void Composer::note(const QString& text) {
    QStringList all;
    if (file_.is_link())
        all += tr("This file is a link: the text is saved to %1.").arg(file_.path());
    if (draft_ && !has_draft_)
        all += tr("Another window has %1 open. Text typed here does not survive a crash, and "
                  "Ctrl+S asks before it overwrites the version saved there.")
                   .arg(file_.name());
    if (!text.isEmpty()) all += text;
    note_ = text;
    const QString now = all.join("\n");
    if (now != notes_ && !now.isEmpty()) Q_EMIT told(now);
    notes_ = now;
    show_state();
}

bool Composer::refuse(const QString& why) {
    refusal_ = why;
    state_->setText(why);
    Q_EMIT told(why);
    return false;
}

void Composer::show_state() {
    QStringList all;
    if (!notes_.isEmpty()) all += notes_;
    if (edit_->isReadOnly())
        all += is_text(file_.content())
                   ? tr("This file cannot be written: first save it under a name of your own "
                        "(Ctrl+Shift+S).")
                   : tr("This file is not UTF-8 text, or contains control characters: it is not "
                        "shown, and cannot be edited here.");
    else if (!problems_.isEmpty())
        all += problems_;
    state_->setText(all.join("\n"));
}

void Composer::check_now() {
    if (!pause_.isActive()) return;
    pause_.stop();
    check();
}

void Composer::show_problems(const QStringList& problems) {
    static const QRegularExpression place(R"(^(.*?):(\d+): (.*)$)",
                                          QRegularExpression::DotMatchesEverythingOption);
    std::map<int, QString> marks;
    QStringList all;
    for (const QString& problem : problems) {
        const auto match = place.match(problem);
        const bool here = match.hasMatch() && match.captured(1) == file_.name();
        if (here) marks[match.captured(2).toInt()] = match.captured(3);
        all += here ? tr("line %1: %2").arg(match.captured(2), match.captured(3)) : problem;
    }
    edit_->mark(marks);
    problems_ = all.join("\n");
    show_state();
}

}  // namespace dihaptic::gui
