#include "rating_view.h"

#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

namespace dihaptic::gui {
namespace {

const QColor kGround(20, 24, 30, 200);
const QColor kInk(255, 255, 255);
const QColor kPointer(255, 180, 60);
constexpr double kCorner = 8;         // [pixels]
constexpr double kBeyondLine = 0.08;  // margin on each side of the line, as a share of the width
constexpr double kMostTicks = 21;

/// The texts below the line, each with its position as a share of the line's length.
std::vector<std::pair<double, QString>> labels_of(const task::AskSpec& question) {
    std::vector<std::pair<double, QString>> out;
    const double range = question.most() - question.least();
    if (question.scale == task::Scale::likert) {
        for (size_t i = 0; i < question.labels.size(); ++i)
            out.emplace_back(static_cast<double>(i) / range,
                             QString("%1 %2")
                                 .arg(question.least() + static_cast<double>(i))
                                 .arg(QString::fromStdString(question.labels[i])));
        return out;
    }
    const bool named = question.labels.size() == 2;
    out.emplace_back(
        0, named ? QString::fromStdString(question.labels[0]) : QString::number(question.least()));
    out.emplace_back(
        1, named ? QString::fromStdString(question.labels[1]) : QString::number(question.most()));
    return out;
}

}  // namespace

RatingView::RatingView(QWidget* parent) : QWidget(parent) {
    setAccessibleName(tr("Scale"));
    setMouseTracking(true);
    hide();
}

void RatingView::set_question(const task::AskSpec* question) {
    if (question == question_) return;
    question_ = question;
    share_ = -1;
    answer_ = kUnmeasured;
    setVisible(question_ != nullptr);
    const bool by_mouse = question_ != nullptr && question_->by == task::AnswerBy::mouse;
    setAttribute(Qt::WA_TransparentForMouseEvents, !by_mouse);
    setCursor(Qt::PointingHandCursor);
    update();
}

void RatingView::set_answer(double answer, bool awaited) {
    const bool same = answer == answer_ || (std::isnan(answer) && std::isnan(answer_));
    if (same && awaited == awaited_) return;
    answer_ = answer;
    awaited_ = awaited;
    update();
}

QRectF RatingView::line() const {
    return {kBeyondLine * width(), 0.4 * height(), (1 - 2 * kBeyondLine) * width(), 0};
}

double RatingView::share_at(const QPointF& pixels) const {
    return std::clamp((pixels.x() - line().left()) / line().width(), 0.0, 1.0);
}

void RatingView::paintEvent(QPaintEvent*) {
    if (question_ == nullptr) return;
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(kGround);
    painter.drawRoundedRect(rect(), kCorner, kCorner);
    const QRectF on = line();
    const double tick = height() / 10.0;
    painter.setPen(QPen(awaited_ ? kPointer : kInk, 2));
    painter.drawLine(on.topLeft(), on.topRight());
    const double steps = question_->most() - question_->least();
    const bool each = question_->whole() && steps < kMostTicks;
    for (double i = 0; i <= (each ? steps : 1); ++i) {
        const double x = on.left() + on.width() * i / (each ? steps : 1);
        painter.drawLine(QPointF(x, on.top() - tick), QPointF(x, on.top() + tick));
    }
    QFont font = painter.font();
    font.setPixelSize(std::max(11, height() / 5));
    painter.setFont(font);
    const auto labels = labels_of(*question_);
    const double room = width() / static_cast<double>(labels.size());
    for (const auto& [share, text] : labels) {
        const double x = on.left() + share * on.width();
        const double left = std::clamp(x - room / 2, 0.0, width() - room);
        const int side = labels.size() > 2 ? Qt::AlignHCenter
                         : share == 0      ? Qt::AlignLeft
                                           : Qt::AlignRight;
        const double inset = labels.size() > 2 ? 0 : on.left() / 2;
        painter.drawText(QRectF(left + inset, on.top() + tick, room - 2 * inset, height()),
                         side | Qt::AlignTop, text);
    }
    if (!std::isnan(answer_)) {
        const double x = on.left() + on.width() * (answer_ - question_->least()) / steps;
        painter.setPen(QPen(kInk, 2));
        painter.setBrush(kPointer);
        painter.drawEllipse(QPointF(x, on.top()), 1.5 * tick, 1.5 * tick);
    }
    if (share_ < 0) return;
    painter.setPen(QPen(kPointer, 4));
    const double x = on.left() + share_ * on.width();
    painter.drawLine(QPointF(x, on.top() - 2 * tick), QPointF(x, on.top() + 2 * tick));
}

void RatingView::mouseMoveEvent(QMouseEvent* event) {
    share_ = share_at(event->position());
    update();
}

void RatingView::mousePressEvent(QMouseEvent* event) {
    if (question_ != nullptr && event->button() == Qt::LeftButton)
        Q_EMIT clicked(share_at(event->position()));
}

void RatingView::leaveEvent(QEvent*) {
    share_ = -1;
    update();
}

}  // namespace dihaptic::gui
