// A field of plain text with several lines. Pasted or dropped data may be missing (an empty
// clipboard, or one whose owner has ended, would end the program with Qt 6.4) or arbitrary:
// characters that no text file may have are dropped.
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
