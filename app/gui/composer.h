// The panel in which the open file is edited: its text, checked and shown as one types, and saved.
// The file stays the truth: a session reads what was saved. Until then nothing in its folder is
// touched, and what was typed is kept as a draft elsewhere.
#pragma once

#include <QLabel>
#include <QMessageBox>
#include <QPointer>
#include <QPushButton>
#include <QTimer>
#include <QWidget>

#include "body_drag.h"
#include "code_edit.h"
#include "draft.h"
#include "edited_file.h"

namespace dihaptic::gui {

class Composer : public QWidget {
    Q_OBJECT

  public:
    explicit Composer(QWidget* parent = nullptr);
    ~Composer() override;

    /// Shows a file; what was not saved of another one is lost. Of the one that is open: looks what
    /// has become of it, and reads it again if another program has changed it and nobody here has.
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
    /// Writes the file, and asks before it overwrites what another program has written since it was
    /// read; false, and says why, if it does not.
    bool save();
    /// Writes the text to another file and leaves this one as it was; false, and says why, if it
    /// cannot.
    bool save_as(const QString& file);
    /// Has what was typed checked now, not after a pause.
    void check_now();
    /// What to read in place of the file while it has changes that were not saved.
    std::optional<std::string> unsaved() const;
    /// Has what was typed outlive the window: nobody can be asked any more. False: it cannot.
    bool leave_draft();
    /// What is wrong with the text: texts with "FILE:LINE: " before them.
    void show_problems(const QStringList& problems);

  Q_SIGNALS:
    /// The text has changed, and is to be checked and shown.
    void edited();
    void saved();
    /// Text that an earlier window left is gone on with: somebody wants to see it.
    void draft_taken();
    /// What has become of the file, or why it was not written.
    void told(const QString& text);
    /// Whether there is something to save, to undo, to redo.
    void modified(bool changed);
    void undo_available(bool available);
    void redo_available(bool available);
    /// The cursor went, or the text changed: it may be in another body's lines.
    void cursor_moved();
    /// CodeEdit's.
    void step_wanted(const QKeyEvent& event);

  private:
    void read_file(const QString& name);
    void look_again();
    /// Shows what the file has, in place of the text.
    void show_content();
    /// Keeps the file from a second window, and offers what an earlier one left.
    void begin_draft();
    void offer(const Draft::Left& left);
    void take(const QString& text);
    /// Keeps what was typed, and has it checked.
    void check();
    void keep_draft();
    void drop_draft();
    void end_draft();
    bool is_writable_text();
    /// Whether the file may be written as it is now; says why if not.
    bool may_write();
    bool may_overwrite();
    /// Says what has become of the file, for as long as it is so, below what else is to be known of
    /// it; "": nothing.
    void note(const QString& text);
    /// Says what keeps the file from being written; returns false.
    bool refuse(const QString& why);
    void show_state();
    /// The text as it is written: with line ends, and a byte order mark, as the file was read.
    QByteArray content() const;

    EditedFile file_;
    std::optional<Draft> draft_;
    bool has_draft_ = false;       // not another window
    bool leaves_ = false;          // the draft, when this ends
    QPointer<QMessageBox> offer_;  // of a draft, about which nobody has decided yet
    QString note_;                 // of what has become of the file
    QString notes_;                // all that is shown of it
    QString problems_;             // of the text, as they are shown
    CodeEdit* edit_;
    QLabel* state_;
    QPushButton* save_;
    WordFinder finder_;
    QTimer pause_;  // until who types pauses
    QTimer look_;   // until the cursor stands still
};

}  // namespace dihaptic::gui
