// A field for the text of a scene or an experiment: line numbers, colours, and marks at the lines
// that have problems.
#pragma once

#include <QPlainTextEdit>
#include <map>

namespace dihaptic::gui {

class CodeEdit : public QPlainTextEdit {
    Q_OBJECT

  public:
    explicit CodeEdit(QWidget* parent = nullptr);

    /// Marks lines, counted from 1, each with what is wrong there; the others lose their marks.
    void mark(const std::map<int, QString>& problems);
    /// Puts the cursor into a line, counted from 1, and shows it.
    void go_to(int line);

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

    Margin* margin_;
    std::map<int, QString> problems_;
};

}  // namespace dihaptic::gui
