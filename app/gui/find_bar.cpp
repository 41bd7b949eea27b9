#include "find_bar.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QPushButton>

namespace dihaptic::gui {

FindBar::FindBar(QPlainTextEdit& text, QWidget* parent)
    : QWidget(parent), text_(text), words_(new QLineEdit), none_(new QLabel(tr("not found"))) {
    words_->setPlaceholderText(tr("Find in this file"));
    words_->setAccessibleName(tr("Find"));
    words_->setClearButtonEnabled(true);
    none_->hide();
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(words_, 1);
    layout->addWidget(none_);
    const auto add_button = [&](const QString& name, const QString& what, auto done) {
        auto* button = new QPushButton(name);
        button->setToolTip(what);
        connect(button, &QPushButton::clicked, this, done);
        layout->addWidget(button);
    };
    add_button(tr("Previous"), tr("Ctrl+Shift+G"), [this] { find(true); });
    add_button(tr("Next"), tr("Ctrl+G, or Enter"), [this] { find(); });
    add_button(tr("Close"), tr("Escape"), [this] { leave(); });
    connect(words_, &QLineEdit::returnPressed, this, [this] { find(); });
    connect(words_, &QLineEdit::textEdited, this, [this] {
        QTextCursor begin = text_.textCursor();
        begin.setPosition(begin.selectionStart());  // a longer word may begin at the same place
        find_from(begin, false);
    });
    hide();
}

void FindBar::ask() {
    const QString selected = text_.textCursor().selectedText();
    if (!selected.isEmpty() && !selected.contains(QChar::ParagraphSeparator))
        words_->setText(selected);
    show();
    words_->setFocus();
    words_->selectAll();
}

void FindBar::find(bool backward) {
    if (words_->text().isEmpty()) return ask();
    find_from(text_.textCursor(), backward);
}

void FindBar::find_from(const QTextCursor& from, bool backward) {
    const QTextDocument::FindFlags way =
        backward ? QTextDocument::FindBackward : QTextDocument::FindFlags();
    QTextCursor found = text_.document()->find(words_->text(), from, way);
    if (found.isNull()) {
        QTextCursor start(text_.document());
        if (backward) start.movePosition(QTextCursor::End);
        found = text_.document()->find(words_->text(), start, way);
    }
    none_->setVisible(found.isNull() && !words_->text().isEmpty());
    if (!found.isNull()) text_.setTextCursor(found);
}

void FindBar::leave() {
    hide();
    text_.setFocus();
}

void FindBar::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape) return leave();
    QWidget::keyPressEvent(event);
}

}  // namespace dihaptic::gui
