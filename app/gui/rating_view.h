// The rating line of a question. If the question is answered by mouse, a click on the line gives
// the answer.
#pragma once

#include <QWidget>

#include "base/unmeasured.h"
#include "task/file/rating.h"

namespace dihaptic::gui {

class RatingView : public QWidget {
    Q_OBJECT

  public:
    explicit RatingView(QWidget* parent);

    /// Sets the question; null removes it. If the pointer is unchanged, so is the question.
    void set_question(const task::AskSpec* question);
    /// Marks the answer, in the unit that its name gives; NaN if there is none. `awaited`: whether
    /// to highlight the line.
    void set_answer(double answer, bool awaited);

  Q_SIGNALS:
    /// The line was clicked. `share`: position of the click along the line, from 0 to 1.
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
    double share_ = -1;  // position of the pointer along the line; negative if not on it
    double answer_ = kUnmeasured;
    bool awaited_ = false;
};

}  // namespace dihaptic::gui
