// A row below a text in which the user types what to find in the text.
#pragma once

#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>

namespace dihaptic::gui {

class FindBar : public QWidget {
    Q_OBJECT

  public:
    explicit FindBar(QPlainTextEdit& text, QWidget* parent = nullptr);

    /// Shows the row, with the text's selection as what to find.
    void ask();
    /// Goes to the next place, or to the previous one; after the last place follows the first.
    void find(bool backward = false);

  protected:
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void leave();
    void find_from(const QTextCursor& from, bool backward);

    QPlainTextEdit& text_;
    QLineEdit* words_;
    QLabel* none_;
};

}  // namespace dihaptic::gui
