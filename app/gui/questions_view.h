// Shows the questions of the current task state over the scene: the line of a rating that is
// answered by mouse, or a form with all its items on one page.
#pragma once

#include <QWidget>
#include <optional>
#include <span>
#include <vector>

#include "rating_view.h"
#include "task/run/answering.h"

QT_BEGIN_NAMESPACE
class QLabel;
class QPushButton;
class QGridLayout;
QT_END_NAMESPACE

namespace dihaptic::gui {

/// The questions that are currently asked.
struct Asked {
    std::span<const task::AskSpec> items;
    QString title;                ///< title of the form
    bool is_form = false;         ///< whether all items are shown, with a button to confirm them
    size_t now = 0;               ///< index of the item awaiting an answer; items.size() if none
    std::vector<double> answers;  ///< answer to each item, in the unit of its name; NaN if missing
    QString typed;                ///< the part of the awaited answer that has been typed
};

class QuestionsView : public QWidget {
    Q_OBJECT

  public:
    explicit QuestionsView(QWidget* parent);

    /// Shows the questions; nullopt removes them.
    void ask(const std::optional<Asked>& asked);
    bool shows_form() const { return is_form_ && count_ > 0; }
    /// Positions the questions over a scene of this size.
    void place(const QSize& room);

  Q_SIGNALS:
    void clicked(const dihaptic::task::Click& click);

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    struct Row {
        QLabel* question;
        RatingView* line;
    };
    void fill(const Asked& asked);
    /// The text of an item: its question, and the answer if known.
    static QString text_of(const Asked& asked, size_t item);
    void fit();

    const task::AskSpec* first_ = nullptr;  // the first of the displayed questions
    size_t count_ = 0;
    bool is_form_ = false;
    QSize room_;
    QGridLayout* layout_;
    QLabel* title_ = nullptr;
    QPushButton* done_ = nullptr;
    std::vector<Row> rows_;
};

}  // namespace dihaptic::gui
