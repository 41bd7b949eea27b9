#include "strip_chart.h"

#include <QPainter>
#include <QPainterPath>
#include <cmath>

namespace dihaptic::gui {
namespace {

/// Width of a curve's entry with its line, and the gap to the next [pixels].
int legend_width(const QFontMetrics& metrics, const StripChart::Curve& curve) {
    return metrics.horizontalAdvance(curve.name) + 26;
}

QColor faint(QColor colour) {
    colour.setAlpha(40);
    return colour;
}

}  // namespace

StripChart::StripChart(QString title, QString unit, std::vector<Curve> curves, double least_range,
                       QWidget* parent)
    : QWidget(parent),
      title_(std::move(title)),
      unit_(std::move(unit)),
      curves_(std::move(curves)),
      least_range_(least_range) {
    setAccessibleName(title_);
}

void StripChart::add(double time, const std::vector<double>& values) {
    if (!samples_.empty() && time < samples_.back().time) samples_.clear();
    if (!samples_.empty() && time == samples_.back().time) return;
    samples_.push_back({time, values});
    while (samples_.front().time < time - kSeconds) samples_.pop_front();
    update();
}

void StripChart::clear() {
    samples_.clear();
    update();
}

Scale StripChart::range(int lines) const {
    double low = 0;
    double high = 0;
    for (const Sample& sample : samples_) {
        for (const double value : sample.values) {
            if (!std::isfinite(value)) continue;
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    high = std::max(high, low + least_range_);
    return scale_of(low, high, lines);
}

/// Maps times [s] and values to the widget.
struct StripChart::Axes {
    QRectF area;
    Scale range;
    double end;  // latest time [s]

    double x(double time) const { return area.right() - (end - time) / kSeconds * area.width(); }
    double y(double value) const {
        return area.bottom() - (value - range.low) / (range.high - range.low) * area.height();
    }
};

void StripChart::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QFontMetrics metrics = fontMetrics();
    const int line = metrics.height();
    const QString heading = QString("%1 / %2").arg(title_, unit_);
    double legend = 0;
    for (const Curve& curve : curves_) legend += legend_width(metrics, curve);
    const bool one_line = metrics.horizontalAdvance(heading) + 10 + legend < width() - 60;
    const int head = (one_line ? 1 : 2) * line;
    const QRectF area(metrics.horizontalAdvance("-0.00") + 8.0, head + 6.0,
                      width() - metrics.horizontalAdvance("-0.00") - 24.0,
                      height() - head - line - 10.0);
    const double end = samples_.empty() ? kSeconds : std::max(kSeconds, samples_.back().time);
    const Axes axes{area, range(static_cast<int>(area.height() / (1.6 * line))), end};

    draw_values(painter, axes);
    draw_times(painter, axes);
    painter.setPen(ink());
    painter.drawText(QRectF(area.left(), 2, area.width(), line), Qt::AlignLeft, heading);
    draw_legend(painter, one_line ? area.right() - legend : area.left(), one_line ? 2 : line + 2);
    painter.setClipRect(area.adjusted(0, -2, 0, 2));
    for (size_t i = 0; i < curves_.size(); ++i) draw_curve(painter, axes, i);
}

QColor StripChart::ink() const {
    return palette().color(QPalette::WindowText);
}

void StripChart::draw_values(QPainter& painter, const Axes& axes) const {
    const auto [low, high, step] = axes.range;
    const QRectF& area = axes.area;
    const int line = fontMetrics().height();
    const int decimals = step < 0.1 ? 2 : step < 1 ? 1 : 0;
    for (int i = 0; low + i * step < high + step / 2; ++i) {
        const double value = low + i * step;
        const double y = axes.y(value);
        painter.setPen(faint(ink()));
        painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
        painter.setPen(ink());
        painter.drawText(QRectF(0, y - line / 2.0, area.left() - 5, line),
                         Qt::AlignRight | Qt::AlignVCenter, QString::number(value, 'f', decimals));
    }
}

void StripChart::draw_times(QPainter& painter, const Axes& axes) const {
    const QRectF& area = axes.area;
    const int line = fontMetrics().height();
    for (double time = std::ceil((axes.end - kSeconds) / 2) * 2; time <= axes.end; time += 2) {
        const double x = axes.x(time);
        painter.setPen(faint(ink()));
        painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
        painter.setPen(ink());
        painter.drawText(QRectF(x - 30, area.bottom() + 2, 60, line), Qt::AlignHCenter,
                         QString::number(time, 'f', 0) + (time + 2 > axes.end ? " s" : ""));
    }
}

void StripChart::draw_legend(QPainter& painter, double left, double top) const {
    const QFontMetrics metrics = fontMetrics();
    const double middle = top + metrics.height() / 2.0;
    for (const Curve& curve : curves_) {
        painter.setPen(QPen(curve.colour, 3));
        painter.drawLine(QPointF(left, middle), QPointF(left + 11, middle));
        painter.setPen(ink());
        painter.drawText(QPointF(left + 15, top + metrics.ascent()), curve.name);
        left += legend_width(metrics, curve);
    }
}

void StripChart::draw_curve(QPainter& painter, const Axes& axes, size_t curve) const {
    QPainterPath path;
    bool drawing = false;
    for (const Sample& sample : samples_) {
        const double value = sample.values[curve];
        const QPointF point(axes.x(sample.time), axes.y(value));
        if (!std::isfinite(value)) {
            drawing = false;
        } else if (drawing) {
            path.lineTo(point);
        } else {
            path.moveTo(point);
            drawing = true;
        }
    }
    painter.setPen(QPen(curves_[curve].colour, 1.8));
    painter.drawPath(path);
}

}  // namespace dihaptic::gui
