// A field for the text of a scene or an experiment: line numbers, colours, marks at the lines that
// have problems, and a list of the words that may be typed.
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

    /// Marks lines, counted from 1, each with what is wrong there; the others lose their marks.
    void mark(const std::map<int, QString>& problems);
    /// Puts the cursor into a line, counted from 1, and shows it.
    void go_to(int line);
    /// The text as it stands, with a line feed behind each line but the last.
    QString text() const;
    /// Replaces parts of text(), by its bytes in UTF-8: one step of undo. The cursor stays where it
    /// is.
    void change(const std::vector<TextChange>& changes);
    /// Offers words for the place where the cursor still is, if there are any that fit.
    void offer(const WordPlace& place, const std::vector<Choice>& words);

  Q_SIGNALS:
    /// Who types wants to know which words may stand at the cursor, or began one.
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
    WordPlace offered_;  // for which words are shown
    Margin* margin_;
    std::map<int, QString> problems_;
};

}  // namespace dihaptic::gui
