#include "trial_chart.h"

#include <QPainter>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace dihaptic::gui {
namespace {

constexpr double kDot = 3;           // radius [px]
constexpr size_t kLeastAcross = 10;  // initial number of trials for which the width is designed

QColor outcome_colour(int outcome) {
    // the first outcome is usually the desired one
    constexpr std::array colours{"#009e73", "#d55e00", "#0072b2", "#cc79a7", "#e69f00"};
    return outcome < 0 ? QColor("#808080")
                       : QColor(colours[static_cast<size_t>(outcome) % colours.size()]);
}

}  // namespace

struct TrialChart::Axes {
    QRectF area;
    Scale range;
    size_t trials;

    double x(size_t i) const {
        return area.left() +
               (static_cast<double>(i) + 0.5) / static_cast<double>(trials) * area.width();
    }
    double y(double value) const {
        return area.bottom() - (value - range.low) / (range.high - range.low) * area.height();
    }
};

TrialChart::TrialChart(QWidget* parent) : QWidget(parent) {
    setAccessibleName(QObject::tr("Chart of trials"));
}

void TrialChart::set_points(const QString& name, const QStringList& outcomes,
                            std::vector<Point> points) {
    name_ = name;
    outcomes_ = outcomes;
    points_ = std::move(points);
    update();
}

void TrialChart::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const int line = fontMetrics().height();
    const double left = fontMetrics().horizontalAdvance("-0.000") + 8.0;
    const QRectF area(left, 2 * line + 6.0, width() - left - 10, height() - 3 * line - 12.0);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point& point : points_) {
        if (!std::isfinite(point.value)) continue;
        low = std::min(low, point.value);
        high = std::max(high, point.value);
    }
    if (low > high) low = 0, high = 1;
    const double least = std::max(1e-3, 0.05 * std::max(std::abs(low), std::abs(high)));
    if (high - low < least) low -= least / 2, high += least / 2;
    const Axes axes{area, scale_of(low, high, area.height() / (1.6 * line)),
                    std::max(kLeastAcross, points_.size())};
    draw_axes(painter, axes);
    draw_legend(painter, area);
    draw_points(painter, axes);
}

void TrialChart::draw_axes(QPainter& painter, const Axes& axes) const {
    const auto [low, high, step] = axes.range;
    const QColor ink = palette().color(QPalette::WindowText);
    QColor thin = ink;
    thin.setAlphaF(0.15f);
    const int line = fontMetrics().height();
    for (int i = 0; low + i * step < high + step / 2; ++i) {
        const double value = low + i * step, y = axes.y(value);
        painter.setPen(thin);
        painter.drawLine(QPointF(axes.area.left(), y), QPointF(axes.area.right(), y));
        painter.setPen(ink);
        painter.drawText(QRectF(0, y - line / 2.0, axes.area.left() - 5, line),
                         Qt::AlignRight | Qt::AlignVCenter, QString::number(value, 'g', 4));
    }
    const auto each = static_cast<size_t>(
        round_step(std::max(1.0, static_cast<double>(axes.trials) * 40 / axes.area.width())));
    for (size_t i = each; i <= axes.trials; i += each)
        painter.drawText(QRectF(axes.x(i - 1) - 30, axes.area.bottom() + 3, 60, line),
                         Qt::AlignHCenter, QString::number(i));
    painter.drawText(QPointF(axes.area.left(), 2.0 + fontMetrics().ascent()), name_);
}

/// The outcomes that occurred.
void TrialChart::draw_legend(QPainter& painter, const QRectF& in) const {
    std::set<int> came;
    for (const Point& point : points_) came.insert(point.outcome);
    const double top = 4.0 + fontMetrics().height();
    double left = in.left();
    for (const int outcome : came) {
        if (outcome < 0 || outcome >= outcomes_.size()) continue;
        painter.setPen(Qt::NoPen);
        painter.setBrush(outcome_colour(outcome));
        painter.drawEllipse(QPointF(left + kDot, top + fontMetrics().height() / 2.0), kDot, kDot);
        painter.setPen(palette().color(QPalette::WindowText));
        painter.drawText(QPointF(left + 3 * kDot, top + fontMetrics().ascent()),
                         outcomes_[outcome]);
        left += 3 * kDot + fontMetrics().horizontalAdvance(outcomes_[outcome]) + 14;
    }
}

void TrialChart::draw_points(QPainter& painter, const Axes& axes) const {
    QColor thin = palette().color(QPalette::WindowText);
    thin.setAlphaF(0.4f);
    painter.setPen(QPen(thin, 1));
    for (size_t i = 1; i < points_.size(); ++i) {
        const double x = (axes.x(i - 1) + axes.x(i)) / 2;
        if (points_[i].begins_block)
            painter.drawLine(QPointF(x, axes.area.top()), QPointF(x, axes.area.bottom()));
        const double from = points_[i - 1].value, to = points_[i].value;
        if (!points_[i].begins_block && std::isfinite(from) && std::isfinite(to))
            painter.drawLine(QPointF(axes.x(i - 1), axes.y(from)), QPointF(axes.x(i), axes.y(to)));
    }
    painter.setPen(Qt::NoPen);
    for (size_t i = 0; i < points_.size(); ++i) {
        if (!std::isfinite(points_[i].value)) continue;
        painter.setBrush(outcome_colour(points_[i].outcome));
        painter.drawEllipse(QPointF(axes.x(i), axes.y(points_[i].value)), kDot, kDot);
    }
}

}  // namespace dihaptic::gui
