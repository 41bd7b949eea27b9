#include "composer.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QRegularExpression>
#include <QSaveFile>
#include <QVBoxLayout>

#include "scene/body_text.h"

namespace dihaptic::gui {
namespace {

constexpr int kPause = 400;  // [ms]
constexpr int kLook = 100;   // [ms]
constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";

QByteArray content_of(const QString& file) {
    QFile in(file);
    return in.open(QIODevice::ReadOnly) ? in.readAll() : QByteArray();
}

/// Writes a file as a whole; returns why it could not.
QString write(const QString& file, const QByteArray& content) {
    QSaveFile out(file);
    if (!out.open(QIODevice::WriteOnly) || out.write(content) < 0 || !out.commit())
        return out.errorString();
    return "";
}

}  // namespace

Composer::Composer(QWidget* parent)
    : QWidget(parent),
      edit_(new CodeEdit),
      state_(new QLabel),
      save_(new QPushButton(tr("Sa&ve"))) {
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
    layout->addLayout(below);
    pause_.setSingleShot(true);
    pause_.setInterval(kPause);
    connect(edit_, &QPlainTextEdit::textChanged, this, [this] {
        if (changed()) pause_.start();
    });
    connect(edit_->document(), &QTextDocument::modificationChanged, this, [this](bool changed) {
        save_->setEnabled(changed);
        Q_EMIT modified(changed);
    });
    connect(&pause_, &QTimer::timeout, this, &Composer::edited);
    look_.setSingleShot(true);
    look_.setInterval(kLook);
    connect(edit_, &QPlainTextEdit::cursorPositionChanged, &look_, qOverload<>(&QTimer::start));
    connect(edit_, &QPlainTextEdit::textChanged, &look_, qOverload<>(&QTimer::start));
    connect(&look_, &QTimer::timeout, this, &Composer::cursor_moved);
    connect(edit_, &QPlainTextEdit::undoAvailable, this, &Composer::undo_available);
    connect(edit_, &QPlainTextEdit::redoAvailable, this, &Composer::redo_available);
    connect(edit_, &CodeEdit::step_wanted, this, &Composer::step_wanted);
    connect(edit_, &CodeEdit::words_wanted, this,
            [this](const WordPlace& place) { finder_.find(file_, place); });
    connect(&finder_, &WordFinder::found, edit_, &CodeEdit::offer);
    connect(save_, &QPushButton::clicked, this, &Composer::save);
}

Composer::~Composer() {
    remove_draft();
}

void Composer::forget() {
    remove_draft();
    file_.clear();
    edit_->document()->setModified(false);
}

QString Composer::draft() const {
    const QFileInfo file(file_);
    return file.dir().filePath("." + file.completeBaseName() + ".draft.yaml");
}

void Composer::remove_draft() {
    if (!file_.isEmpty()) QFile::remove(draft());
}

void Composer::open(const QString& file) {
    const QByteArray content = content_of(file);
    if (file == file_ && (changed() || content == read_)) return;
    remove_draft();
    file_ = file;
    read_ = content;
    edit_->setPlainText(QString::fromUtf8(content));
    edit_->document()->setModified(false);
    pause_.stop();  // nobody typed this
    edit_->setReadOnly(!QFileInfo(file).isWritable());
    state_->setText(edit_->isReadOnly()
                        ? tr("This file may not be written: save it under a name of "
                             "your own first (Ctrl+Shift+S).")
                        : "");
}

QByteArray Composer::content() const {
    QString text = edit_->text();
    if (read_.contains("\r\n")) text.replace("\n", "\r\n");
    return (read_.startsWith(kByteOrderMark) ? kByteOrderMark : "") + text.toUtf8();
}

QString Composer::source() {
    if (!changed()) return file_;
    const QString why = write(draft(), content());
    if (why.isEmpty()) return draft();
    state_->setText(tr("The text cannot be checked as you type: %1: %2").arg(draft(), why));
    return file_;
}

bool Composer::go_to(const Place& place) {
    const QString file = QString::fromStdString(place.file);
    if (place.line < 1 || (file != file_ && file != draft())) return false;
    edit_->go_to(place.line);
    return true;
}

std::string Composer::body() const {
    const QString text = edit_->text();
    const QByteArray before = text.left(edit_->textCursor().position()).toUtf8();
    return scene::body_at(text.toStdString(), static_cast<size_t>(before.size()));
}

bool Composer::move(const std::string& body, const BodyWay& way) {
    if (edit_->isReadOnly()) return false;  // it says so all the time
    if (body.empty()) {
        state_->setText(tr("The cursor is not in the lines of a body: nothing moves."));
        return false;
    }
    try {
        edit_->change(scene::moved_body(edit_->text().toStdString(), body, way.way, way.turn));
        state_->setText(problems_);
        return true;
    } catch (const Error& e) {
        state_->setText(e.what());
        return false;
    }
}

bool Composer::save() {
    if (!changed()) return true;
    const QByteArray written = content();
    if (const QString why = write(file_, written); !why.isEmpty()) {
        state_->setText(tr("%1 cannot be written: %2").arg(file_, why));
        return false;
    }
    read_ = written;
    pause_.stop();
    edit_->document()->setModified(false);
    remove_draft();
    Q_EMIT saved();
    return true;
}

bool Composer::save_as(const QString& file) {
    if (const QString why = write(file, content()); !why.isEmpty()) {
        state_->setText(tr("%1 cannot be written: %2").arg(file, why));
        return false;
    }
    forget();
    return true;
}

void Composer::check_now() {
    if (!pause_.isActive()) return;
    pause_.stop();
    Q_EMIT edited();
}

void Composer::show_problems(const QStringList& problems) {
    static const QRegularExpression place(R"(^(.*?):(\d+): (.*)$)",
                                          QRegularExpression::DotMatchesEverythingOption);
    std::map<int, QString> marks;
    QStringList all;
    for (const QString& problem : problems) {
        const auto match = place.match(problem);
        const bool here =
            match.hasMatch() && (match.captured(1) == file_ || match.captured(1) == draft());
        if (here) marks[match.captured(2).toInt()] = match.captured(3);
        all += here ? tr("line %1: %2").arg(match.captured(2), match.captured(3)) : problem;
    }
    edit_->mark(marks);
    problems_ = all.join("\n");
    if (!edit_->isReadOnly()) state_->setText(problems_);
}

}  // namespace dihaptic::gui
