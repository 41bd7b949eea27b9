#include "strip_chart.h"

#include <cmath>

namespace dihaptic::gui {

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

void StripChart::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QFontMetrics metrics = fontMetrics();
    const int line = metrics.height();
    const QString heading = QString("%1 [%2]").arg(title_, unit_);
    const double legend = ChartPainter::legend_width(metrics, curves_);
    const bool one_line = metrics.horizontalAdvance(heading) + 10 + legend < width() - 60;
    const int head = (one_line ? 1 : 2) * line;
    const QRectF area(metrics.horizontalAdvance("-0.00") + 8.0, head + 6.0,
                      width() - metrics.horizontalAdvance("-0.00") - 24.0,
                      height() - head - line - 10.0);
    const double end = samples_.empty() ? kSeconds : std::max(kSeconds, samples_.back().time);
    const Scale scale = range(static_cast<int>(area.height() / (1.6 * line)));
    const ChartPainter chart(painter, *this, area, end - kSeconds, end, scale);
    chart.draw_values(scale.step < 0.1 ? 2 : scale.step < 1 ? 1 : 0);
    for (double time = std::ceil((end - kSeconds) / 2) * 2; time <= end; time += 2)
        chart.draw_tick(time, QString::number(time, 'f', 0) + (time + 2 > end ? " s" : ""), true);
    painter.setPen(chart.ink());
    painter.drawText(QRectF(area.left(), 2, area.width(), line), Qt::AlignLeft, heading);
    chart.draw_legend(one_line ? area.right() - legend : area.left(), one_line ? 2 : line + 2,
                      curves_, ChartPainter::Mark::line);
    painter.setClipRect(area.adjusted(0, -2, 0, 2));
    for (size_t i = 0; i < curves_.size(); ++i) {
        std::vector<QPointF> points;
        for (const Sample& sample : samples_) points.emplace_back(sample.time, sample.values[i]);
        chart.draw_curve(points, QPen(curves_[i].colour, 1.8));
    }
}

}  // namespace dihaptic::gui
