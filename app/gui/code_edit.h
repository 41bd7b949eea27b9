// A field for the text of a scene or an experiment: line numbers, colours, marks at lines with
// problems, and a list of the words that may be typed.
#pragma once

#include <QCompleter>
#include <map>

#include "base/written.h"
#include "plain_text.h"
#include "word_finder.h"

namespace dihaptic::gui {

class CodeEdit : public PlainText {
    Q_OBJECT

  public:
    explicit CodeEdit(QWidget* parent = nullptr);

    /// Marks lines, counted from 1, each with its problem; all other marks are removed.
    void mark(const std::map<int, QString>& problems);
    /// Puts the cursor into a line, counted from 1, and shows it.
    void go_to(int line);
    /// The present text, with a line feed after each line but the last.
    QString text() const;
    /// Replaces parts of text(), given by positions in its UTF-8 bytes, as one step of undo. The
    /// cursor keeps its position.
    void change(const std::vector<TextChange>& changes);
    /// Offers words for this position, if the cursor is still at it and any words fit.
    void offer(const WordPlace& place, const std::vector<Choice>& words);

  Q_SIGNALS:
    /// The user requested the words that are possible at the cursor, or started typing one.
    void words_wanted(const dihaptic::gui::WordPlace& place);
    /// A key was pressed, with Alt, that may move a body.
    void step_wanted(const QKeyEvent& event);

  protected:
    void resizeEvent(QResizeEvent* event) override;
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
    WordPlace offered_;  // position for which words are shown
    Margin* margin_;
    std::map<int, QString> problems_;
};

}  // namespace dihaptic::gui
