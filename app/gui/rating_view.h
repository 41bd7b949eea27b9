// The line of a question. If it is answered by mouse, a click on the line is the answer.
#pragma once

#include <QWidget>

#include "base/unmeasured.h"
#include "task/file/rating.h"

namespace dihaptic::gui {

class RatingView : public QWidget {
    Q_OBJECT

  public:
    explicit RatingView(QWidget* parent);

    /// Sets the question; null: none. An unchanged pointer means an unchanged question.
    void set_question(const task::AskSpec* question);
    /// Marks the answer, in the unit of its name; NaN: none. `awaited`: the line is highlighted.
    void set_answer(double answer, bool awaited);

  Q_SIGNALS:
    /// `share`: of the line, from 0 to 1.
    void clicked(double share);

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;

  private:
    QRectF line() const;
    double share_at(const QPointF& pixels) const;

    const task::AskSpec* question_ = nullptr;
    double share_ = -1;  // position of the pointer; negative: not on the line
    double answer_ = kUnmeasured;
    bool awaited_ = false;
};

}  // namespace dihaptic::gui
