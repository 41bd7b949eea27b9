#include "plain_text.h"

#include <QInputMethodEvent>
#include <QMimeData>
#include <algorithm>

#include "base/text.h"

namespace dihaptic::gui {

QString clean_text(const QString& text) {
    QString out = text;
    out.replace("\r\n", "\n");
    for (const QChar end :
         {QChar('\r'), QChar(QChar::LineSeparator), QChar(QChar::ParagraphSeparator)})
        out.replace(end, '\n');
    out = QString::fromStdString(mended(out.toStdString()));
    return out.remove(QChar(QChar::ReplacementCharacter));
}

bool PlainText::canInsertFromMimeData(const QMimeData* source) const {
    return source != nullptr && QPlainTextEdit::canInsertFromMimeData(source);
}

void PlainText::insertFromMimeData(const QMimeData* source) {
    if (source == nullptr || isReadOnly()) return;
    const QString text = clean_text(source->text());
    if (text.isEmpty()) return;
    insertPlainText(text);
    ensureCursorVisible();
}

void PlainText::inputMethodEvent(QInputMethodEvent* event) {
    const QString text = clean_text(event->commitString());
    if (text != event->commitString())
        event->setCommitString(text, event->replacementStart(), event->replacementLength());
    QPlainTextEdit::inputMethodEvent(event);
}

}  // namespace dihaptic::gui
