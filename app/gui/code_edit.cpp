#include "code_edit.h"

#include <QHelpEvent>
#include <QPainter>
#include <QRegularExpression>
#include <QSyntaxHighlighter>
#include <QTextBlock>
#include <QToolTip>
#include <algorithm>

namespace dihaptic::gui {
namespace {

constexpr int kMarginSpace = 12;  // [px]
const QColor kProblem("#d55e00");

/// Colours comments, keys, and texts in quotes.
class Colours final : public QSyntaxHighlighter {
  public:
    using QSyntaxHighlighter::QSyntaxHighlighter;

  protected:
    void highlightBlock(const QString& text) override {
        static const QRegularExpression key(R"((?:^|[\s{,\-])([A-Za-z_][\w ]*):(?=\s|$))");
        static const QRegularExpression quoted(R"("[^"]*"|'[^']*')");
        static const QRegularExpression comment(R"((?:^|\s)#.*$)");
        QTextCharFormat format;
        format.setForeground(QColor("#0072b2"));
        for (auto it = key.globalMatch(text); it.hasNext();) {
            const auto match = it.next();
            setFormat(static_cast<int>(match.capturedStart(1)),
                      static_cast<int>(match.capturedLength(1)), format);
        }
        format.setForeground(QColor("#007f5c"));
        for (auto it = quoted.globalMatch(text); it.hasNext();) {
            const auto match = it.next();
            setFormat(static_cast<int>(match.capturedStart()),
                      static_cast<int>(match.capturedLength()), format);
        }
        format.setForeground(QColor("#808080"));
        if (const auto match = comment.match(text); match.hasMatch())
            setFormat(static_cast<int>(match.capturedStart()),
                      static_cast<int>(match.capturedLength()), format);
    }
};

}  // namespace

/// The line numbers.
class CodeEdit::Margin final : public QWidget {
  public:
    explicit Margin(CodeEdit& edit) : QWidget(&edit), edit_(edit) {}

  protected:
    void paintEvent(QPaintEvent* event) override { edit_.draw_margin(*event); }

  private:
    CodeEdit& edit_;
};

CodeEdit::CodeEdit(QWidget* parent) : QPlainTextEdit(parent), margin_(new Margin(*this)) {
    QFont font("monospace");
    font.setStyleHint(QFont::Monospace);
    setFont(font);
    setLineWrapMode(NoWrap);
    new Colours(document());
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

void CodeEdit::resizeEvent(QResizeEvent* event) {
    QPlainTextEdit::resizeEvent(event);
    lay_out();
}

void CodeEdit::draw_margin(QPaintEvent& event) {
    QPainter painter(margin_);
    painter.fillRect(event.rect(), palette().color(QPalette::AlternateBase));
    QTextBlock block = firstVisibleBlock();
    double top = blockBoundingGeometry(block).translated(contentOffset()).top();
    for (; block.isValid() && top <= event.rect().bottom(); block = block.next()) {
        const double height = blockBoundingRect(block).height();
        const int line = block.blockNumber() + 1;
        painter.setPen(problems_.contains(line) ? kProblem
                                                : palette().color(QPalette::PlaceholderText));
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
    return QPlainTextEdit::viewportEvent(event);
}

/// YAML takes no tabs, and a new line mostly goes on where the last one began.
void CodeEdit::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Tab) {
        insertPlainText("  ");
        return;
    }
    if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) {
        const QString line = textCursor().block().text();
        const auto leading =
            std::find_if(line.begin(), line.end(), [](QChar c) { return c != ' '; });
        insertPlainText("\n" + QString(leading - line.begin(), ' '));
        return;
    }
    QPlainTextEdit::keyPressEvent(event);
}

}  // namespace dihaptic::gui
