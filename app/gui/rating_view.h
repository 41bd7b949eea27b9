// The line of a question that is answered by mouse. It lies over the scene, and a click on it is
// the answer.
#pragma once

#include <QWidget>

#include "task/file/rating.h"

namespace dihaptic::gui {

class RatingView : public QWidget {
    Q_OBJECT

  public:
    explicit RatingView(QWidget* parent);

    /// Sets the question; null: none. An unchanged pointer means an unchanged question.
    void set_question(const task::AskSpec* question);

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
    double share_ = -1;  // position of the pointer; negative: elsewhere
};

}  // namespace dihaptic::gui
