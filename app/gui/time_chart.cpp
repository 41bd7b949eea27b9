#include "time_chart.h"

#include <QMouseEvent>
#include <algorithm>
#include <cmath>

#include "base/palette.h"

namespace dihaptic::gui {
namespace {

constexpr double kShortestStretch = 0.02;  // shortest interval that can be shown [s]

QColor colour_of(size_t row) {
    if (row == 0) return palette::kGrip;
    if (row == 1) return palette::kLoad;
    return palette::finger(row - 1);
}

}  // namespace

TimeChart::TimeChart(QWidget* parent) : QWidget(parent) {
    setAccessibleName(tr("Curves"));
    setMouseTracking(false);
}

void TimeChart::set_session(double begin, double end) {
    first_ = begin;
    last_ = std::max(end, begin + kShortestStretch);
    begin_ = first_;
    end_ = last_;
    update();
}

void TimeChart::set_curves(std::vector<RecordedCurve> curves, double begin, double end,
                           double share) {
    curves_ = std::move(curves);
    curves_begin_ = begin;
    curves_end_ = end;
    share_ = share;
    update();
}

void TimeChart::set_values(const QStringList& values) {
    values_ = values;
    update();
}

void TimeChart::set_moments(std::vector<double> times) {
    moments_ = std::move(times);
    update();
}

void TimeChart::set_cursor(double time) {
    cursor_ = time;
    const double span = end_ - begin_;
    if (time < begin_ || time > end_) show_stretch(time - span / 2, time + span / 2);
    update();
}

QRectF TimeChart::area() const {
    const int line = fontMetrics().height();
    const double left = fontMetrics().horizontalAdvance("-0000.0") + 8.0;
    return {left, 8.0, std::max(10.0, width() - left - 12.0),
            std::max(10.0, height() - line - 12.0)};
}

double TimeChart::time_at(double x) const {
    const QRectF in = area();
    const double share = std::clamp((x - in.left()) / in.width(), 0.0, 1.0);
    return begin_ + share * (end_ - begin_);
}

void TimeChart::show_stretch(double begin, double end) {
    const double span = std::clamp(end - begin, kShortestStretch, last_ - first_);
    begin_ = std::clamp(begin, first_, last_ - span);
    end_ = begin_ + span;
    update();
    Q_EMIT stretch_changed();
}

void TimeChart::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF in = area();
    const double row = in.height() / static_cast<double>(std::max<size_t>(1, curves_.size()));
    for (size_t i = 0; i < curves_.size(); ++i)
        draw_row(painter, i,
                 {in.left(), in.top() + static_cast<double>(i) * row, in.width(), row - 14});
    const ChartPainter chart(painter, *this, in, begin_, end_, {});
    draw_times(chart);
    painter.setClipRect(in.adjusted(-1, 0, 1, 0));
    for (const double moment : moments_) {
        if (moment >= begin_ && moment <= end_)
            chart.draw_upright(moment, QPen(chart.ink(60), 1, Qt::DotLine));
    }
    chart.draw_upright(cursor_, QPen(chart.ink(), 1.5));
    if (share_ < 1)
        painter.drawText(in, Qt::AlignRight | Qt::AlignTop,
                         tr("reading, %1 % ").arg(std::lround(100 * share_)));
}

void TimeChart::draw_row(QPainter& painter, size_t row, const QRectF& in) const {
    const RecordedCurve& curve = curves_[row];
    const double part = (curves_end_ - curves_begin_) / static_cast<double>(curve.low.size());
    std::vector<QPointF> points;
    double least = 0, most = 0;
    for (size_t i = 0; i < curve.low.size(); ++i) {
        if (!std::isfinite(curve.low[i]) || !std::isfinite(curve.high[i])) continue;
        const double at = curves_begin_ + (static_cast<double>(i) + 0.5) * part;
        points.emplace_back(at, curve.low[i]);
        points.emplace_back(at, curve.high[i]);
        least = std::min(least, points[points.size() - 2].y());
        most = std::max(most, points.back().y());
    }
    if (most <= least) most = least + 1;
    const double lines = in.height() / (2.0 * fontMetrics().height());
    const ChartPainter chart(painter, *this, in, begin_, end_, scale_of(least, most, lines));
    chart.draw_values();
    painter.save();
    painter.setClipRect(in);
    // drawn as separate lines, because short lines within one curve would look thinner
    painter.setPen(QPen(colour_of(row), 1.4));
    for (size_t i = 1; i < points.size(); ++i)
        painter.drawLine(chart.at(points[i - 1]), chart.at(points[i]));
    painter.restore();
    const QString value = static_cast<qsizetype>(row) < values_.size()
                              ? values_[static_cast<qsizetype>(row)]
                              : QString();
    painter.setPen(colour_of(row));
    painter.drawText(in.adjusted(6, 0, 0, 0), Qt::AlignLeft | Qt::AlignTop,
                     value.isEmpty() ? tr("%1   has no value here").arg(curve.name)
                                     : QString("%1   %2 %3").arg(curve.name, value, curve.unit));
}

void TimeChart::draw_times(const ChartPainter& chart) const {
    const double step = round_step((end_ - begin_) / std::max(2.0, area().width() / 90));
    const int decimals = step < 0.01 ? 3 : step < 0.1 ? 2 : step < 1 ? 1 : 0;
    for (double time = std::ceil(begin_ / step) * step; time <= end_ + 1e-9; time += step)
        chart.draw_tick(time, QString::number(time, 'f', decimals) + " s");
}

void TimeChart::mousePressEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) Q_EMIT moment_chosen(time_at(event->position().x()));
}

void TimeChart::mouseMoveEvent(QMouseEvent* event) {
    if (event->buttons().testFlag(Qt::LeftButton))
        Q_EMIT moment_chosen(time_at(event->position().x()));
}

void TimeChart::mouseDoubleClickEvent(QMouseEvent*) {
    show_stretch(first_, last_);
}

void TimeChart::wheelEvent(QWheelEvent* event) {
    const double notches = event->angleDelta().y() / 120.0;
    const double about = time_at(event->position().x());
    const double factor = std::pow(0.8, notches);
    show_stretch(about - (about - begin_) * factor, about + (end_ - about) * factor);
    event->accept();
}

}  // namespace dihaptic::gui
