// A field of plain text with several lines. What is pasted or dropped may be nothing (the clipboard
// is empty, or its owner is gone: Qt 6.4 would end the program) or anything: what no text file may
// have is left out.
#pragma once

#include <QPlainTextEdit>

namespace dihaptic::gui {

/// The text without control characters, except tabs and line feeds, and with no other line ends.
QString clean_text(const QString& text);

class PlainText : public QPlainTextEdit {
    Q_OBJECT

  public:
    using QPlainTextEdit::QPlainTextEdit;

  protected:
    bool canInsertFromMimeData(const QMimeData* source) const override;
    void insertFromMimeData(const QMimeData* source) override;
    void inputMethodEvent(QInputMethodEvent* event) override;
};

}  // namespace dihaptic::gui
