// The panel in which the open file is edited: its text, checked and shown as one types, and saved.
// The file stays the truth: a session reads what was saved.
#pragma once

#include <QLabel>
#include <QPushButton>
#include <QTimer>
#include <QWidget>

#include "body_drag.h"
#include "code_edit.h"

namespace dihaptic::gui {

class Composer : public QWidget {
    Q_OBJECT

  public:
    explicit Composer(QWidget* parent = nullptr);
    ~Composer() override;

    /// Shows a file; what was not saved of another one is lost. Reads it again if it is the same
    /// one, was changed by another program, and has no changes here.
    void open(const QString& file);
    bool changed() const { return edit_->document()->isModified(); }
    /// What was not saved is lost.
    void forget();
    void take_focus() { edit_->setFocus(); }
    /// Puts the cursor where that was written; false: it was written in another file.
    bool go_to(const Place& place);
    /// Name of the body in whose lines the cursor is; empty: none.
    std::string body() const;
    /// Has the text put a body elsewhere; false, and says why, if it cannot. A way of nothing: says
    /// only whether it can.
    bool move(const std::string& body, const BodyWay& way);
    /// Shows a text below the file's, until something else is to be told.
    void tell(const QString& text) { state_->setText(text); }
    void undo() { edit_->undo(); }
    void redo() { edit_->redo(); }
    /// Writes the file; false, and says why, if it cannot.
    bool save();
    /// Writes the text to another file and leaves this one as it was; false, and says why, if it
    /// cannot.
    bool save_as(const QString& file);
    /// Has what was typed checked now, not after a pause.
    void check_now();
    /// The file to be read: the open one or, while it has changes that were not saved, a draft of
    /// it beside it.
    QString source();
    /// What is wrong with what source() named: texts with "FILE:LINE: " before them.
    void show_problems(const QStringList& problems);

  Q_SIGNALS:
    /// The text has changed, and is to be checked and shown.
    void edited();
    void saved();
    /// Whether there is something to save, to undo, to redo.
    void modified(bool changed);
    void undo_available(bool available);
    void redo_available(bool available);
    /// The cursor went, or the text changed: it may be in another body's lines.
    void cursor_moved();
    /// CodeEdit's.
    void step_wanted(const QKeyEvent& event);

  private:
    QString draft() const;
    void remove_draft();
    /// The text as it is written: with line ends, and a byte order mark, as the file was read.
    QByteArray content() const;

    QString file_;
    QByteArray read_;   // the file as it was read or saved last
    QString problems_;  // of the text, as they are shown
    CodeEdit* edit_;
    QLabel* state_;
    QPushButton* save_;
    WordFinder finder_;
    QTimer pause_;  // until who types pauses
    QTimer look_;   // until the cursor stands still
};

}  // namespace dihaptic::gui
