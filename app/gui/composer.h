// The panel in which the open file is edited: its text is checked and shown while the user types,
// and can be saved. The file on disk remains authoritative: a session reads the saved version.
// Until the user saves, nothing in the file's folder is modified, and the unsaved text is kept as a
// draft elsewhere.
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
#include "find_bar.h"

namespace dihaptic::gui {

class Composer : public QWidget {
    Q_OBJECT

  public:
    explicit Composer(QWidget* parent = nullptr);
    ~Composer() override;

    /// Why a file cannot be opened as a text, with the remedy; "" if it can be.
    static QString why_not_to_open(const QString& file);
    /// Opens a file; unsaved changes to another file are lost. If the file is already open, checks
    /// its state on disk, and reads it again if another program has changed it and the user has
    /// not.
    void open(const QString& file);
    bool changed() const { return edit_->document()->isModified(); }
    /// Discards unsaved changes.
    void forget();
    void take_focus() { edit_->setFocus(); }
    bool has_focus() const { return edit_->hasFocus(); }
    /// Asks what to find in the text.
    void find() { find_->ask(); }
    void find_next() { find_->find(); }
    void find_previous() { find_->find(true); }
    /// Moves the cursor to this position. Returns false if the position is in another file.
    bool go_to(const Place& place);
    /// Name of the body whose lines contain the cursor; empty if there is none.
    std::string body() const;
    /// Changes the text so that a body moves. If this is not possible, shows a message and returns
    /// false. A zero move only checks whether the body can be moved.
    bool move(const std::string& body, const BodyWay& way);
    /// Shows a message below the file's text, until the next message.
    void tell(const QString& text) { state_->setText(text); }
    void undo() { edit_->undo(); }
    void redo() { edit_->redo(); }
    /// Writes the file. Asks before overwriting later changes by another program. If the file is
    /// not written, shows a message and returns false.
    bool save();
    /// The message with which the last save() or save_as() refused to write.
    const QString& refusal() const { return refusal_; }
    /// Writes the text to another file and leaves the open file unchanged. If writing fails, shows
    /// a message and returns false.
    bool save_as(const QString& file);
    /// Checks the text immediately, without waiting for a pause in typing.
    void check_now();
    /// The text to be read instead of the file while there are unsaved changes; otherwise nullopt.
    std::optional<std::string> unsaved() const;
    /// Keeps the unsaved text as a draft when the window closes without being able to ask the user.
    /// Returns false if this fails.
    bool leave_draft();
    /// Shows the faults of the text, each preceded by "FILE:LINE: ".
    void show_problems(const QStringList& problems);

  Q_SIGNALS:
    /// The text has changed and should be checked and displayed.
    void edited();
    void saved();
    /// The user chose to continue with the text that an earlier window left.
    void draft_taken();
    /// A message about the state of the file, or the reason why the file was not written.
    void told(const QString& text);
    /// Whether there is anything to save or, in the next two signals, to undo and to redo.
    void modified(bool changed);
    void undo_available(bool available);
    void redo_available(bool available);
    /// The cursor may now be in another body's lines, because it moved or the text changed.
    void cursor_moved();
    /// The text should be saved under another name.
    void save_as_wanted();
    /// Passes on the signal of the same name from CodeEdit.
    void step_wanted(const QKeyEvent& event);

  private:
    void read_file(const QString& name);
    void look_again();
    /// Replaces the text with the file's contents.
    void show_content();
    /// Reserves the file's draft for this window, and offers the draft left by an earlier window.
    void begin_draft();
    void offer(const Draft::Left& left);
    void take(const QString& text);
    /// Keeps the text as a draft and checks it.
    void check();
    void keep_draft();
    void drop_draft();
    void end_draft();
    bool is_writable_text();
    /// Whether the file may be written in its present state. If not, shows the reason.
    bool may_write();
    bool may_replace(const QString& file, const QStringList& endings);
    bool may_overwrite();
    /// Shows a note about the state of the file below other messages, for as long as the state
    /// lasts; "" removes the note.
    void note(const QString& text);
    /// Shows the reason why the file cannot be written; returns false.
    bool refuse(const QString& why);
    void show_state();
    /// The bytes that will be written: the text with the line ends and the byte order mark of the
    /// file that was read.
    QByteArray content() const;

    EditedFile file_;
    std::optional<Draft> draft_;
    bool has_draft_ = false;       // whether this window holds the draft
    bool leaves_ = false;          // whether the draft is kept when this panel is destroyed
    QPointer<QMessageBox> offer_;  // offer of a draft that the user has not answered yet
    QString refusal_;              // why the text was last not written
    QString note_;                 // note about the state of the file
    QString notes_;                // all notes that are shown
    QString problems_;             // shown problems of the text
    CodeEdit* edit_;
    FindBar* find_;
    QLabel* state_;
    QPushButton* save_;
    WordFinder finder_;
    QTimer pause_;  // expires when the user pauses in typing
    QTimer look_;   // expires when the cursor has rested
};

}  // namespace dihaptic::gui
