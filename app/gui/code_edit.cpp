#include "code_edit.h"

#include <QAbstractItemView>
#include <QApplication>
#include <QHelpEvent>
#include <QPainter>
#include <QRegularExpression>
#include <QScreen>
#include <QScrollBar>
#include <QStandardItemModel>
#include <QSyntaxHighlighter>
#include <QTextBlock>
#include <QToolTip>
#include <algorithm>

#include "indent.h"
#include "theme.h"

namespace dihaptic::gui {
namespace {

constexpr int kMarginSpace = 12;  // [px]
const QColor kProblem("#d55e00");

/// Colours comments, keys, and quoted text, so that they can be read in the present theme.
class Colours final : public QSyntaxHighlighter {
  public:
    using QSyntaxHighlighter::QSyntaxHighlighter;

  protected:
    void highlightBlock(const QString& text) override {
        static const QRegularExpression key(R"((?:^|[\s{,\-])([A-Za-z_][\w ]*):(?=\s|$))");
        static const QRegularExpression quoted(R"("[^"]*"|'[^']*')");
        static const QRegularExpression comment(R"((?:^|\s)#.*$)");
        QTextCharFormat format;
        const QColor paper = QApplication::palette().color(QPalette::Base);
        format.setForeground(readable("#0072b2", paper));
        for (auto it = key.globalMatch(text); it.hasNext();) {
            const auto match = it.next();
            setFormat(static_cast<int>(match.capturedStart(1)),
                      static_cast<int>(match.capturedLength(1)), format);
        }
        format.setForeground(readable("#007f5c", paper));
        for (auto it = quoted.globalMatch(text); it.hasNext();) {
            const auto match = it.next();
            setFormat(static_cast<int>(match.capturedStart()),
                      static_cast<int>(match.capturedLength()), format);
        }
        format.setForeground(readable("#808080", paper));
        if (const auto match = comment.match(text); match.hasMatch())
            setFormat(static_cast<int>(match.capturedStart()),
                      static_cast<int>(match.capturedLength()), format);
    }
};

}  // namespace

/// The margin that shows the line numbers.
class CodeEdit::Margin final : public QWidget {
  public:
    explicit Margin(CodeEdit& edit) : QWidget(&edit), edit_(edit) {}

  protected:
    void paintEvent(QPaintEvent* event) override { edit_.draw_margin(*event); }

  private:
    CodeEdit& edit_;
};

CodeEdit::CodeEdit(QWidget* parent)
    : PlainText(parent), words_(new QCompleter(this)), margin_(new Margin(*this)) {
    QFont font("monospace");
    font.setStyleHint(QFont::Monospace);
    setFont(font);
    setLineWrapMode(NoWrap);
    colours_ = new Colours(document());
    words_->setWidget(this);
    words_->setModel(new QStandardItemModel(words_));
    words_->setCompletionRole(Qt::UserRole);  // inserts only the word itself
    words_->setMaxVisibleItems(12);
    words_->popup()->setFont(font);
    connect(words_, qOverload<const QModelIndex&>(&QCompleter::activated), this,
            &CodeEdit::take_word);
    connect(this, &QPlainTextEdit::blockCountChanged, this, &CodeEdit::lay_out);
    connect(this, &QPlainTextEdit::updateRequest, this, [this](const QRect& area, int dy) {
        if (dy != 0) {
            margin_->scroll(0, dy);
        } else {
            margin_->update(0, area.y(), margin_->width(), area.height());
        }
    });
    lay_out();
}

int CodeEdit::margin_width() const {
    const QString widest = QString::number(std::max(99, blockCount()));
    return fontMetrics().horizontalAdvance(widest) + kMarginSpace;
}

void CodeEdit::lay_out() {
    setViewportMargins(margin_width(), 0, 0, 0);
    const QRect area = contentsRect();
    margin_->setGeometry(area.left(), area.top(), margin_width(), area.height());
}

void CodeEdit::changeEvent(QEvent* event) {
    PlainText::changeEvent(event);
    if (event->type() == QEvent::PaletteChange && colours_ != nullptr) colours_->rehighlight();
}

void CodeEdit::resizeEvent(QResizeEvent* event) {
    // problems shown below the text make the field smaller, but the current line stays visible
    const bool seen = QRect(QPoint(), event->oldSize()).contains(cursorRect().center());
    PlainText::resizeEvent(event);
    lay_out();
    if (seen) ensureCursorVisible();
}

void CodeEdit::draw_margin(QPaintEvent& event) {
    QPainter painter(margin_);
    const QColor paper = palette().color(QPalette::AlternateBase);
    painter.fillRect(event.rect(), paper);
    QTextBlock block = firstVisibleBlock();
    double top = blockBoundingGeometry(block).translated(contentOffset()).top();
    for (; block.isValid() && top <= event.rect().bottom(); block = block.next()) {
        const double height = blockBoundingRect(block).height();
        const int line = block.blockNumber() + 1;
        painter.setPen(readable(
            problems_.contains(line) ? kProblem : palette().color(QPalette::PlaceholderText),
            paper));
        painter.drawText(QRectF(0, top, margin_->width() - kMarginSpace / 2.0, height),
                         Qt::AlignRight, QString::number(line));
        top += height;
    }
}

void CodeEdit::mark(const std::map<int, QString>& problems) {
    problems_ = problems;
    show_marks();
    margin_->update();
}

void CodeEdit::show_marks() {
    QList<QTextEdit::ExtraSelection> all;
    for (const auto& [line, problem] : problems_) {
        QTextEdit::ExtraSelection selection;
        selection.cursor = QTextCursor(document()->findBlockByNumber(line - 1));
        selection.cursor.select(QTextCursor::LineUnderCursor);
        selection.format.setUnderlineStyle(QTextCharFormat::WaveUnderline);
        selection.format.setUnderlineColor(kProblem);
        all += selection;
    }
    setExtraSelections(all);
}

QString CodeEdit::text() const {
    // toPlainText() would turn no-break spaces into ordinary spaces
    QString out = document()->toRawText();
    return out.replace(QChar::ParagraphSeparator, '\n').replace(QChar::LineSeparator, '\n');
}

void CodeEdit::change(const std::vector<TextChange>& changes) {
    const QByteArray bytes = text().toUtf8();
    const auto sign = [&](size_t byte) {
        return static_cast<int>(QString::fromUtf8(bytes.left(static_cast<int>(byte))).size());
    };
    QTextCursor cursor = textCursor();  // undoing moves the cursor back to this position
    cursor.beginEditBlock();
    for (auto change = changes.rbegin(); change != changes.rend(); ++change) {
        cursor.setPosition(sign(change->at));
        cursor.setPosition(sign(change->at + change->length), QTextCursor::KeepAnchor);
        cursor.insertText(QString::fromStdString(change->text));
    }
    cursor.endEditBlock();
}

void CodeEdit::go_to(int line) {
    setTextCursor(QTextCursor(document()->findBlockByNumber(line - 1)));
    centerCursor();
    setFocus();
}

bool CodeEdit::viewportEvent(QEvent* event) {
    if (event->type() == QEvent::ToolTip) {
        const auto& help = static_cast<const QHelpEvent&>(*event);
        const int line = cursorForPosition(help.pos()).blockNumber() + 1;
        const auto found = problems_.find(line);
        QToolTip::showText(help.globalPos(), found == problems_.end() ? "" : found->second, this);
        return true;
    }
    return PlainText::viewportEvent(event);
}

/// `anyhow`: whether to ask even if no word has been started.
void CodeEdit::ask_for_words(bool anyhow) {
    if (isReadOnly()) return;
    const WordPlace place = word_place(text(), textCursor().position());
    if (anyhow || (place.is_key && !place.has_colon && !place.typed.isEmpty()))
        Q_EMIT words_wanted(place);
}

void CodeEdit::offer(const WordPlace& place, const std::vector<Choice>& words) {
    const WordPlace now = word_place(text(), textCursor().position());
    if (now.asking != place.asking || !hasFocus()) return;  // the cursor has moved in the meantime
    auto& model = static_cast<QStandardItemModel&>(*words_->model());
    model.clear();
    const QFontMetrics metrics(words_->popup()->font());
    words_width_ = 0;
    size_t longest = 0;
    for (const Choice& word : words) longest = std::max(longest, word.word.size());
    for (const Choice& word : words) {
        const QString name = QString::fromStdString(word.word);
        auto* item = new QStandardItem(name.leftJustified(static_cast<int>(longest) + 2) +
                                       QString::fromStdString(word.what));
        item->setData(name, Qt::UserRole);
        model.appendRow(item);
        words_width_ = std::max(words_width_, metrics.horizontalAdvance(item->text()));
    }
    WordPlace here = place;
    here.typed = now.typed;
    show_words(here);
}

void CodeEdit::show_words(const WordPlace& place) {
    offered_ = place;
    words_->setCompletionPrefix(place.typed);
    const bool is_whole =
        words_->completionCount() == 1 && words_->currentCompletion() == place.typed;
    if (words_->completionCount() == 0 || is_whole) return words_->popup()->hide();
    words_->popup()->setCurrentIndex(words_->completionModel()->index(0, 0));
    QRect at = cursorRect();
    at.translate(margin_width(), 0);
    // sizeHintForColumn() would measure only the entries that happen to be visible
    const int edge = 2 * (words_->popup()->frameWidth() + kMarginSpace / 2) +
                     words_->popup()->verticalScrollBar()->sizeHint().width();
    at.setWidth(std::min(words_width_ + edge, screen()->availableSize().width()));
    words_->complete(at);
}

void CodeEdit::take_word(const QModelIndex& word) {
    QTextCursor cursor = textCursor();
    cursor.movePosition(QTextCursor::Left, QTextCursor::KeepAnchor,
                        static_cast<int>(offered_.typed.size()));
    QString text = word.data(Qt::UserRole).toString();
    if (offered_.is_key && !offered_.has_colon) text += ": ";
    cursor.insertText(text);
    setTextCursor(cursor);
}

/// Tab inserts spaces, because YAML does not allow tabs, and a new line is indented.
void CodeEdit::keyPressEvent(QKeyEvent* event) {
    const bool choosing = words_->popup()->isVisible();
    if (choosing && QList<int>{Qt::Key_Return, Qt::Key_Enter, Qt::Key_Tab, Qt::Key_Escape}.contains(
                        event->key()))
        return event->ignore();  // the word list handles this key
    if (event->key() == Qt::Key_Space && event->modifiers().testFlag(Qt::ControlModifier))
        return ask_for_words(true);
    if (event->modifiers().testFlag(Qt::AltModifier)) Q_EMIT step_wanted(*event);
    if (event->key() == Qt::Key_Tab) {
        insertPlainText("  ");
        return;
    }
    if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) {
        QTextCursor at = textCursor();
        at.setPosition(at.selectionStart());
        insertPlainText("\n" +
                        QString(indent_after(at.block().text().left(at.positionInBlock())), ' '));
        return ensureCursorVisible();
    }
    PlainText::keyPressEvent(event);
    if (event->text().isEmpty()) return;
    const WordPlace now = word_place(text(), textCursor().position());
    if (choosing && now.asking == offered_.asking) {
        offered_.typed = now.typed;
        return show_words(offered_);
    }
    words_->popup()->hide();
    ask_for_words(false);
}

}  // namespace dihaptic::gui
