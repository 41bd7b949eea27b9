#include "plane_chart.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "theme.h"

namespace dihaptic::gui {

PlaneChart::PlaneChart(double least_range, bool alike, QWidget* parent)
    : QWidget(parent), least_range_(least_range), alike_(alike) {}

void PlaneChart::set_names(const QString& title, const QString& across) {
    title_ = title;
    across_ = across;
    setAccessibleName(title);
    update();
}

void PlaneChart::set_result(const QString& text) {
    result_ = text;
    update();
}

void PlaneChart::set(std::vector<Line> lines, std::vector<Circle> circles) {
    lines_ = std::move(lines);
    circles_ = std::move(circles);
    update();
}

/// The smallest rectangle that holds everything.
QRectF PlaneChart::bounds() const {
    QRectF out;
    bool first = true;
    const auto add = [&](const QPointF& point, double margin) {
        if (!std::isfinite(point.x()) || !std::isfinite(point.y())) return;
        const QRectF around(point.x() - margin, point.y() - margin, 2 * margin, 2 * margin);
        // not QRectF::united(), which ignores rectangles without an area
        out = first ? around
                    : QRectF(QPointF(std::min(out.left(), around.left()),
                                     std::min(out.top(), around.top())),
                             QPointF(std::max(out.right(), around.right()),
                                     std::max(out.bottom(), around.bottom())));
        first = false;
    };
    for (const Line& line : lines_) {
        for (const QPointF& point : line.points) add(point, 0);
    }
    for (const Circle& circle : circles_) add(circle.centre, circle.radius);
    return out;
}

/// What the area shows: bounds(), not smaller than the least range, and in proportion if the axes
/// are alike. The upper edge is the rectangle's bottom.
QRectF PlaneChart::shown_bounds(const QRectF& area) const {
    QRectF out = bounds();
    const auto widen = [&](double width, double height) {
        const double x = std::max(0.0, width - out.width()) / 2;
        const double y = std::max(0.0, height - out.height()) / 2;
        out.adjust(-x, -y, x, y);
    };
    if (!alike_) {
        // forces begin at zero, and the largest is not drawn on the edge
        const auto end = [&](double largest) { return 1.05 * std::max(least_range_, largest); };
        return {QPointF(std::min(0.0, out.left()), std::min(0.0, out.top())),
                QPointF(end(out.right()), end(out.bottom()))};
    }
    widen(1.1 * std::max(least_range_, out.width()), 1.1 * std::max(least_range_, out.height()));
    const double ratio = area.width() / std::max(1.0, area.height());
    widen(out.height() * ratio, out.width() / ratio);
    return out;
}

/// Number of lines of text above the chart.
int PlaneChart::heading_lines() const {
    const bool named =
        std::ranges::any_of(lines_, [](const Line& of) { return !of.name.isEmpty(); });
    return named || !result_.isEmpty() ? 2 : 1;
}

void PlaneChart::draw_heading(const ChartPainter& chart, QPainter& painter,
                              const QRectF& area) const {
    const int line = fontMetrics().height();
    std::vector<ChartPainter::Entry> legend;
    for (const Line& of : lines_) {
        if (!of.name.isEmpty()) legend.push_back({of.name, of.colour});
    }
    painter.setPen(chart.ink());
    painter.drawText(QRectF(area.left(), 2, area.width(), line), Qt::AlignLeft, title_);
    painter.drawText(QRectF(area.left(), line + 2, area.width(), line), Qt::AlignLeft, result_);
    const double width = ChartPainter::legend_width(fontMetrics(), legend);
    chart.draw_legend(area.right() - width, result_.isEmpty() ? line + 2 : 2, legend,
                      ChartPainter::Mark::line);
}

void PlaneChart::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const int line = fontMetrics().height();
    const double left = fontMetrics().horizontalAdvance("-0000") + 8.0;
    const int beside = heading_lines() + (across_.isEmpty() ? 1 : 2);  // lines of text
    const QRectF area(left, heading_lines() * line + 8.0, width() - left - 12,
                      std::max(20.0, height() - beside * line - 16.0));
    const QRectF shown = shown_bounds(area);
    Scale up = scale_of(shown.top(), shown.bottom(), area.height() / (1.8 * line));
    if (alike_) up = {shown.top(), shown.bottom(), up.step};  // an even scale would stretch it
    const ChartPainter chart(painter, *this, area, shown.left(), shown.right(), up);
    if (alike_ && up.high - up.low > up.step) {
        const double first = std::ceil(up.low / up.step) * up.step;
        const double last = std::floor(up.high / up.step) * up.step;
        const ChartPainter ticks(
            painter, *this,
            QRectF(QPointF(area.left(), chart.y(last)), QPointF(area.right(), chart.y(first))), 0,
            1, {first, last, up.step});
        ticks.draw_values();
    } else if (!alike_) {
        chart.draw_values();
    }
    const double step =
        round_step(std::max(1e-9, shown.width() / std::max(2.0, area.width() / 60)));
    for (double x = std::ceil(shown.left() / step) * step; x <= shown.right() + 1e-9; x += step)
        chart.draw_tick(x, QString::number(std::abs(x) < step / 1e3 ? 0 : x, 'g', 4), true);
    painter.setPen(chart.ink());
    painter.drawText(QRectF(area.left(), height() - line - 2.0, area.width(), line),
                     Qt::AlignHCenter, across_);
    draw_heading(chart, painter, area);
    painter.setClipRect(area.adjusted(-2, -2, 2, 2));
    for (const Circle& circle : circles_) {
        painter.setPen(QPen(circle.colour, 1.5));
        QColor inside = circle.colour;
        inside.setAlpha(60);
        painter.setBrush(inside);
        const double radius = circle.radius / shown.width() * area.width();
        painter.drawEllipse(chart.at(circle.centre), radius, radius);
    }
    painter.setBrush(Qt::NoBrush);
    for (const Line& of : lines_) {
        chart.draw_curve(of.points, QPen(of.colour, of.width));
        if (of.name.isEmpty() || of.points.empty()) continue;
        chart.draw_dot(chart.at(of.points.back()), of.colour);
    }
}

}  // namespace dihaptic::gui
