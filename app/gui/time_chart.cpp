#include "time_chart.h"

#include <QMouseEvent>
#include <algorithm>
#include <cmath>

#include "base/palette.h"

namespace dihaptic::gui {
namespace {

constexpr double kShortestStretch = 0.02;  // shortest interval that can be shown [s]

QColor colour_of(size_t curve) {
    if (curve == 0) return palette::kGrip;
    if (curve == 1) return palette::kLoad;
    return palette::finger(curve - 1);
}

/// A colour that is chosen for a white ground, as it is drawn on the ground of this palette.
QColor on_ground(const QColor& colour, const QPalette& palette) {
    constexpr int kLighter = 150;  // [%]
    return palette.color(QPalette::Window).lightness() < 128 ? colour.lighter(kLighter) : colour;
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
    const std::vector<std::vector<size_t>> rows = this->rows();
    const double row = in.height() / static_cast<double>(std::max<size_t>(1, rows.size()));
    for (size_t i = 0; i < rows.size(); ++i)
        draw_row(painter, rows[i],
                 {in.left(), in.top() + static_cast<double>(i) * row, in.width(), row - 14});
    const ChartPainter chart(painter, *this, in, begin_, end_, {});
    draw_times(chart);
    painter.setClipRect(in.adjusted(-1, 0, 1, 0));
    for (const double moment : moments_) {
        if (moment >= begin_ && moment <= end_)
            chart.draw_upright(moment, QPen(chart.ink(60), 1, Qt::DotLine));
    }
    if (on_paper_) return;
    chart.draw_upright(cursor_, QPen(chart.ink(), 1.5));
    if (share_ < 1)
        painter.drawText(in, Qt::AlignRight | Qt::AlignTop,
                         tr("reading, %1 % ").arg(std::lround(100 * share_)));
}

std::vector<std::vector<size_t>> TimeChart::rows() const {
    std::vector<std::vector<size_t>> out;
    for (size_t i = 0; i < curves_.size(); ++i) {
        const auto same = std::ranges::find_if(out, [&](const std::vector<size_t>& row) {
            return curves_[row.front()].unit == curves_[i].unit;
        });
        if (same == out.end()) {
            out.push_back({i});
        } else {
            same->push_back(i);
        }
    }
    return out;
}

std::vector<QPointF> TimeChart::points_of(const RecordedCurve& curve) const {
    const double part = (curves_end_ - curves_begin_) / static_cast<double>(curve.low.size());
    std::vector<QPointF> out;
    for (size_t i = 0; i < curve.low.size(); ++i) {
        if (!std::isfinite(curve.low[i]) || !std::isfinite(curve.high[i])) continue;
        const double at = curves_begin_ + (static_cast<double>(i) + 0.5) * part;
        out.emplace_back(at, curve.low[i]);
        out.emplace_back(at, curve.high[i]);
    }
    return out;
}

void TimeChart::draw_row(QPainter& painter, const std::vector<size_t>& curves,
                         const QRectF& in) const {
    std::vector<std::vector<QPointF>> all;
    double least = 0, most = 0;
    for (const size_t i : curves) {
        for (const QPointF& point : all.emplace_back(points_of(curves_[i]))) {
            least = std::min(least, point.y());
            most = std::max(most, point.y());
        }
    }
    if (most <= least) most = least + 1;
    const double lines = in.height() / (2.0 * fontMetrics().height());
    const ChartPainter chart(painter, *this, in, begin_, end_, scale_of(least, most, lines));
    chart.draw_values();
    painter.save();
    painter.setClipRect(in);
    painter.setBrush(Qt::NoBrush);
    for (size_t i = 0; i < curves.size(); ++i) {
        // on the screen, drawn as separate lines, because short lines within one curve would look
        // thinner
        painter.setPen(QPen(on_ground(colour_of(curves[i]), palette()), 1.4));
        if (on_paper_) {
            chart.draw_curve(all[i], painter.pen());  // the file stays small
            continue;
        }
        for (size_t k = 1; k < all[i].size(); ++k)
            painter.drawLine(chart.at(all[i][k - 1]), chart.at(all[i][k]));
    }
    painter.restore();
    draw_names(painter, curves, in);
}

/// Writes the name of each curve of a row, with the value at the cursor.
void TimeChart::draw_names(QPainter& painter, const std::vector<size_t>& curves,
                           const QRectF& in) const {
    double left = in.left() + 6;
    for (const size_t i : curves) {
        const RecordedCurve& curve = curves_[i];
        const auto place = static_cast<qsizetype>(i);
        const QString value = place < values_.size() ? values_[place] : QString();
        const QString text = on_paper_ ? QString("%1 [%2]").arg(curve.name, curve.unit)
                             : value.isEmpty()
                                 ? tr("%1   has no value here").arg(curve.name)
                                 : QString("%1   %2 %3").arg(curve.name, value, curve.unit);
        painter.setPen(on_ground(colour_of(i), palette()));
        painter.drawText(QRectF(left, in.top(), in.right() - left, in.height()),
                         Qt::AlignLeft | Qt::AlignTop, text);
        left += fontMetrics().horizontalAdvance(text) + 24;
    }
}

std::unique_ptr<TimeChart> TimeChart::on_paper() const {
    auto out = std::make_unique<TimeChart>();
    out->on_paper_ = true;
    out->setPalette(QPalette(Qt::black, Qt::white, Qt::white, Qt::darkGray, Qt::gray, Qt::black,
                             Qt::white, Qt::white, Qt::white));
    out->resize(size());
    out->first_ = first_;
    out->last_ = last_;
    out->begin_ = begin_;
    out->end_ = end_;
    out->share_ = share_;
    out->curves_ = curves_;
    out->curves_begin_ = curves_begin_;
    out->curves_end_ = curves_end_;
    return out;
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
