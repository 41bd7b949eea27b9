#include "strip_chart.h"

#include <QPainter>
#include <QPainterPath>
#include <cmath>

namespace dihaptic::gui {
namespace {

/// The next of 1, 2, 5, 10, ... above.
double round_step(double least) {
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least) return factor * power;
    }
    return 10 * power;
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

StripChart::Range StripChart::range(int lines) const {
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
    const double step = round_step((high - low) / std::max(1, lines));
    // what is as good as zero opens no step below it
    return {std::floor(low / step + 0.05) * step, std::ceil(high / step - 0.05) * step, step};
}

void StripChart::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QFontMetrics metrics = fontMetrics();
    const int line = metrics.height();
    const QString heading = QString("%1 / %2").arg(title_, unit_);
    double legend = 0;
    for (const Curve& curve : curves_) legend += metrics.horizontalAdvance(curve.name) + 26;
    const bool one_line = metrics.horizontalAdvance(heading) + 10 + legend < width() - 60;
    const int head = (one_line ? 1 : 2) * line;
    const QRectF area(metrics.horizontalAdvance("-0.00") + 8.0, head + 6.0,
                      width() - metrics.horizontalAdvance("-0.00") - 24.0,
                      height() - head - line - 10.0);
    const auto [low, high, step] = range(static_cast<int>(area.height() / (1.6 * line)));
    const double end = samples_.empty() ? kSeconds : std::max(kSeconds, samples_.back().time);
    const auto x = [&](double time) {
        return area.right() - (end - time) / kSeconds * area.width();
    };
    const auto y = [&](double value) {
        return area.bottom() - (value - low) / (high - low) * area.height();
    };

    const QColor ink = palette().color(QPalette::WindowText);
    QColor faint = ink;
    faint.setAlpha(40);
    const int decimals = step < 0.1 ? 2 : step < 1 ? 1 : 0;
    for (int i = 0; low + i * step < high + step / 2; ++i) {
        const double value = low + i * step;
        painter.setPen(faint);
        painter.drawLine(QPointF(area.left(), y(value)), QPointF(area.right(), y(value)));
        painter.setPen(ink);
        painter.drawText(QRectF(0, y(value) - line / 2.0, area.left() - 5, line),
                         Qt::AlignRight | Qt::AlignVCenter, QString::number(value, 'f', decimals));
    }
    for (double time = std::ceil((end - kSeconds) / 2) * 2; time <= end; time += 2) {
        painter.setPen(faint);
        painter.drawLine(QPointF(x(time), area.top()), QPointF(x(time), area.bottom()));
        painter.setPen(ink);
        painter.drawText(QRectF(x(time) - 30, area.bottom() + 2, 60, line), Qt::AlignHCenter,
                         QString::number(time, 'f', 0) + (time + 2 > end ? " s" : ""));
    }

    painter.setPen(ink);
    painter.drawText(QRectF(area.left(), 2, area.width(), line), Qt::AlignLeft, heading);
    double left = one_line ? area.right() - legend : area.left();
    const double top = one_line ? 2 : line + 2;
    for (const Curve& curve : curves_) {
        painter.setPen(QPen(curve.colour, 3));
        painter.drawLine(QPointF(left, top + line / 2.0), QPointF(left + 11, top + line / 2.0));
        painter.setPen(ink);
        painter.drawText(QPointF(left + 15, top + metrics.ascent()), curve.name);
        left += metrics.horizontalAdvance(curve.name) + 26;
    }

    painter.setClipRect(area.adjusted(0, -2, 0, 2));
    for (size_t i = 0; i < curves_.size(); ++i) {
        QPainterPath path;
        bool drawing = false;
        for (const Sample& sample : samples_) {
            const double value = sample.values[i];
            const QPointF point(x(sample.time), y(value));
            if (!std::isfinite(value)) {
                drawing = false;
            } else if (drawing) {
                path.lineTo(point);
            } else {
                path.moveTo(point);
                drawing = true;
            }
        }
        painter.setPen(QPen(curves_[i].colour, 1.8));
        painter.drawPath(path);
    }
}

}  // namespace dihaptic::gui
