// A plain-text field with several lines. Pasted or dropped data may be missing (with Qt 6.4, an
// empty clipboard, or one whose owner has exited, would crash the program) or arbitrary: characters
// that are not allowed in text files are dropped.
#pragma once

#include <QPlainTextEdit>

namespace dihaptic::gui {

/// The text with uniform line feeds, and without control characters except tabs and line feeds.
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
