// A text field for a scene or an experiment, with line numbers, colours, marks at lines with
// problems, and a list of the words that may be typed.
#pragma once

#include <QCompleter>
#include <QSyntaxHighlighter>
#include <map>

#include "base/written.h"
#include "plain_text.h"
#include "word_finder.h"

namespace dihaptic::gui {

class CodeEdit : public PlainText {
    Q_OBJECT

  public:
    explicit CodeEdit(QWidget* parent = nullptr);

    /// Marks the given lines, counted from 1, each with its problem, and removes all other marks.
    void mark(const std::map<int, QString>& problems);
    /// Moves the cursor to the given line, counted from 1, and scrolls it into view.
    void go_to(int line);
    /// The current text, with a line feed after every line except the last.
    QString text() const;
    /// Replaces parts of text(), given as positions in its UTF-8 encoding, in a single undo step.
    /// The cursor keeps its position.
    void change(const std::vector<TextChange>& changes);
    /// Shows a list of words for this position, if the cursor is still there and any words fit.
    void offer(const WordPlace& place, const std::vector<Choice>& words);

  Q_SIGNALS:
    /// The user requested the words that are possible at the cursor, or started to type a word.
    void words_wanted(const dihaptic::gui::WordPlace& place);
    /// A key that may move a body was pressed together with Alt.
    void step_wanted(const QKeyEvent& event);

  protected:
    void resizeEvent(QResizeEvent* event) override;
    void changeEvent(QEvent* event) override;
    bool viewportEvent(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    class Margin;
    int margin_width() const;
    void draw_margin(QPaintEvent& event);
    void lay_out();
    void show_marks();
    void ask_for_words(bool anyhow);
    void show_words(const WordPlace& place);
    void take_word(const QModelIndex& word);

    QCompleter* words_;
    QSyntaxHighlighter* colours_ = nullptr;
    WordPlace offered_;    // position for which the word list is shown
    int words_width_ = 0;  // width of the longest entry of the word list [pixels]
    Margin* margin_;
    std::map<int, QString> problems_;
};

}  // namespace dihaptic::gui
