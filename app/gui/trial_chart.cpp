#include "trial_chart.h"

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "theme.h"

namespace dihaptic::gui {
namespace {

constexpr size_t kLeastAcross = 10;  // number of trials for which there is room at first

}  // namespace

TrialChart::TrialChart(QWidget* parent) : QWidget(parent) {
    setAccessibleName(QObject::tr("Chart of trials"));
}

void TrialChart::set_points(const QString& name, std::vector<ChartPainter::Entry> outcomes,
                            std::vector<Point> points) {
    name_ = name;
    outcomes_ = std::move(outcomes);
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
    const size_t trials = std::max(kLeastAcross, points_.size());
    const double count = static_cast<double>(trials);
    const ChartPainter chart(painter, *this, area, -0.5, count - 0.5,
                             scale_of(low, high, area.height() / (1.6 * line)));
    chart.draw_values();
    const auto each = static_cast<size_t>(round_step(std::max(1.0, count * 40 / area.width())));
    for (size_t i = each; i <= trials; i += each)
        chart.draw_tick(static_cast<double>(i - 1), QString::number(i));
    painter.drawText(QPointF(area.left(), 2.0 + fontMetrics().ascent()), name_);
    chart.draw_legend(area.left(), 4.0 + line, legend(), ChartPainter::Mark::dot);
    draw_points(chart);
}

/// The outcomes that have occurred, with their colours.
std::vector<ChartPainter::Entry> TrialChart::legend() const {
    std::set<int> came;
    for (const Point& point : points_) came.insert(point.outcome);
    std::vector<ChartPainter::Entry> out;
    for (const int outcome : came) {
        if (outcome >= 0 && static_cast<size_t>(outcome) < outcomes_.size())
            out.push_back(outcomes_[static_cast<size_t>(outcome)]);
    }
    return out;
}

QColor TrialChart::colour_of(int outcome) const {
    const auto i = static_cast<size_t>(outcome);
    return outcome >= 0 && i < outcomes_.size() ? outcomes_[i].colour : legible("#808080");
}

void TrialChart::draw_points(const ChartPainter& chart) const {
    constexpr int kAlpha = 102;
    const QPen thin(chart.ink(kAlpha), 1);
    std::vector<QPointF> curve;
    for (size_t i = 0; i < points_.size(); ++i) {
        const auto at = static_cast<double>(i);
        if (i > 0 && points_[i].begins_block) {
            chart.draw_upright(at - 0.5, thin);
            curve.emplace_back(at, std::numeric_limits<double>::quiet_NaN());  // a gap
        }
        curve.emplace_back(at, points_[i].value);
    }
    chart.draw_curve(curve, thin);
    for (size_t i = 0; i < points_.size(); ++i) {
        const QPointF point(static_cast<double>(i), points_[i].value);
        if (std::isfinite(point.y()))
            chart.draw_dot(chart.at(point), colour_of(points_[i].outcome));
    }
}

}  // namespace dihaptic::gui
