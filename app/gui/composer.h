// The panel in which the open file is edited: its text is checked and shown while the user types,
// and can be saved. The file remains authoritative: a session reads the saved version. Until the
// user saves, nothing in the file's folder is touched, and the unsaved text is kept as a draft
// elsewhere.
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

    /// Shows a file; unsaved changes of another file are lost. If the file is already open, checks
    /// its state, and reads it again if another program changed it and the user did not.
    void open(const QString& file);
    bool changed() const { return edit_->document()->isModified(); }
    /// Discards unsaved changes.
    void forget();
    void take_focus() { edit_->setFocus(); }
    /// Puts the cursor at this position; false if it is in another file.
    bool go_to(const Place& place);
    /// Name of the body whose lines contain the cursor; empty if there is none.
    std::string body() const;
    /// Changes the text so that a body moves; false, with a message, if it cannot. A zero move only
    /// checks whether it is possible.
    bool move(const std::string& body, const BodyWay& way);
    /// Shows a message below the file's text, until the next one.
    void tell(const QString& text) { state_->setText(text); }
    void undo() { edit_->undo(); }
    void redo() { edit_->redo(); }
    /// Writes the file, and asks before overwriting another program's later changes; false, with a
    /// message, if it does not write.
    bool save();
    /// Writes the text to another file and leaves this one unchanged; false, with a message, if
    /// this fails.
    bool save_as(const QString& file);
    /// Checks the text now, not after a pause.
    void check_now();
    /// The text to read in place of the file while there are unsaved changes.
    std::optional<std::string> unsaved() const;
    /// Keeps the unsaved text when the window closes and the user can no longer be asked. False if
    /// this fails.
    bool leave_draft();
    /// Faults of the text, each with "FILE:LINE: " before it.
    void show_problems(const QStringList& problems);

  Q_SIGNALS:
    /// The text has changed, and should be checked and shown.
    void edited();
    void saved();
    /// The user continues with text that an earlier window left.
    void draft_taken();
    /// The state of the file, or why it was not written.
    void told(const QString& text);
    /// Whether there is anything to save, to undo, to redo.
    void modified(bool changed);
    void undo_available(bool available);
    void redo_available(bool available);
    /// The cursor moved, or the text changed, so it may be in another body's lines.
    void cursor_moved();
    /// The same signal as in CodeEdit.
    void step_wanted(const QKeyEvent& event);

  private:
    void read_file(const QString& name);
    void look_again();
    /// Replaces the text by the file's content.
    void show_content();
    /// Reserves the file against a second window, and offers the draft left by an earlier one.
    void begin_draft();
    void offer(const Draft::Left& left);
    void take(const QString& text);
    /// Keeps the text as a draft, and checks it.
    void check();
    void keep_draft();
    void drop_draft();
    void end_draft();
    bool is_writable_text();
    /// Whether the file may be written in its present state; shows the reason if not.
    bool may_write();
    bool may_overwrite();
    /// Shows the state of the file, as long as it lasts, below other messages; "": nothing.
    void note(const QString& text);
    /// Shows the reason why the file cannot be written; returns false.
    bool refuse(const QString& why);
    void show_state();
    /// The text as it will be written: with line ends and byte order mark as in the file that was
    /// read.
    QByteArray content() const;

    EditedFile file_;
    std::optional<Draft> draft_;
    bool has_draft_ = false;       // whether this window, not another, holds the draft
    bool leaves_ = false;          // whether the draft is left when this ends
    QPointer<QMessageBox> offer_;  // offer of a draft about which the user has not decided yet
    QString note_;                 // note about the state of the file
    QString notes_;                // all notes shown
    QString problems_;             // problems of the text, as shown
    CodeEdit* edit_;
    QLabel* state_;
    QPushButton* save_;
    WordFinder finder_;
    QTimer pause_;  // waits until the user pauses in typing
    QTimer look_;   // waits until the cursor rests
};

}  // namespace dihaptic::gui
