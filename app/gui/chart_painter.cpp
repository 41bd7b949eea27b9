#include "chart_painter.h"

#include <QPainterPath>
#include <algorithm>
#include <cmath>

namespace dihaptic::gui {
namespace {

constexpr int kFaint = 40;  // alpha of the lines behind the curves
// dimensions of a legend [pixels]
constexpr double kLine = 11;    // length of a line
constexpr double kToName = 4;   // distance from a mark to its name
constexpr double kToNext = 11;  // distance from a name to the next mark

}  // namespace

double round_step(double least) {
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least) return factor * power;
    }
    return 10 * power;
}

Scale scale_of(double low, double high, double lines) {
    const double step = round_step((high - low) / std::max(1.0, lines));
    // a value that is practically on a line does not extend the scale by another step
    return {std::floor(low / step + 0.05) * step, std::ceil(high / step - 0.05) * step, step};
}

QColor ChartPainter::ink(int alpha) const {
    QColor colour = widget_.palette().color(QPalette::WindowText);
    colour.setAlpha(alpha);
    return colour;
}

void ChartPainter::draw_values(int decimals) const {
    const int line = widget_.fontMetrics().height();
    for (int i = 0; scale_.low + i * scale_.step < scale_.high + scale_.step / 2; ++i) {
        const double value = scale_.low + i * scale_.step;
        painter_.setPen(ink(kFaint));
        painter_.drawLine(QPointF(area_.left(), y(value)), QPointF(area_.right(), y(value)));
        painter_.setPen(ink());
        painter_.drawText(
            QRectF(0, y(value) - line / 2.0, area_.left() - 5, line),
            Qt::AlignRight | Qt::AlignVCenter,
            decimals < 0 ? QString::number(value, 'g', 4) : QString::number(value, 'f', decimals));
    }
}

void ChartPainter::draw_tick(double where, const QString& text, bool lined) const {
    if (lined) draw_upright(where, ink(kFaint));
    painter_.setPen(ink());
    painter_.drawText(QRectF(x(where) - 40, area_.bottom() + 3, 80, widget_.fontMetrics().height()),
                      Qt::AlignHCenter, text);
}

void ChartPainter::draw_upright(double where, const QPen& pen) const {
    painter_.setPen(pen);
    painter_.drawLine(QPointF(x(where), area_.top()), QPointF(x(where), area_.bottom()));
}

void ChartPainter::draw_curve(const std::vector<QPointF>& points, const QPen& pen) const {
    QPainterPath path;
    bool drawing = false;
    for (const QPointF& point : points) {
        const bool is_there = std::isfinite(point.y());
        if (is_there && drawing) path.lineTo(at(point));
        if (is_there && !drawing) path.moveTo(at(point));
        drawing = is_there;
    }
    painter_.strokePath(path, pen);
}

void ChartPainter::draw_dot(const QPointF& centre, const QColor& colour) const {
    painter_.setPen(Qt::NoPen);
    painter_.setBrush(colour);
    painter_.drawEllipse(centre, kDot, kDot);
}

void ChartPainter::draw_legend(double left, double top, const std::vector<Entry>& entries,
                               Mark mark) const {
    const QFontMetrics metrics = widget_.fontMetrics();
    const double middle = top + metrics.height() / 2.0;
    const double width = mark == Mark::line ? kLine : 2 * kDot;
    for (const Entry& entry : entries) {
        if (mark == Mark::dot) {
            draw_dot({left + kDot, middle}, entry.colour);
        } else {
            painter_.setPen(QPen(entry.colour, 3));
            painter_.drawLine(QPointF(left, middle), QPointF(left + width, middle));
        }
        painter_.setPen(ink());
        left += width + kToName;
        painter_.drawText(QPointF(left, top + metrics.ascent()), entry.name);
        left += metrics.horizontalAdvance(entry.name) + kToNext;
    }
}

double ChartPainter::legend_width(const QFontMetrics& metrics, const std::vector<Entry>& entries) {
    double out = 0;
    for (const Entry& entry : entries)
        out += kLine + kToName + metrics.horizontalAdvance(entry.name) + kToNext;
    return out;
}

}  // namespace dihaptic::gui
