#include "trial_strip.h"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <cmath>
#include <utility>

#include "chart_painter.h"
#include "theme.h"

namespace dihaptic::gui {
namespace {

constexpr int kNone = -2;           // outcome of a trial that has not been tried
constexpr double kLeastCell = 2.5;  // width of a trial [pixels]
constexpr int kStrip = 30;          // height of the strip [pixels]

}  // namespace

TrialStrip::TrialStrip(QWidget* parent) : QWidget(parent) {
    setAccessibleName(tr("All trials"));
    setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
}

QSize TrialStrip::sizeHint() const {
    return {200, kStrip + fontMetrics().height()};
}

void TrialStrip::set_plan(std::shared_ptr<const task::TaskPlan> plan) {
    plan_ = std::move(plan);
    kinds_ = plan_ ? outcomes_of(*plan_) : std::vector<ChartPainter::Entry>();
    outcomes_.assign(plan_ ? plan_->trials.size() : 0, kNone);
    current_ = 0;
    update();
}

void TrialStrip::add(const session::TrialEnd& end) {
    const auto trial = static_cast<size_t>(end.trial) - 1;
    if (trial >= outcomes_.size()) return;
    outcomes_[trial] = end.outcome;
    update();
}

void TrialStrip::set_current(int trial) {
    if (std::exchange(current_, trial) != trial) update();
}

int TrialStrip::count(int outcome) const {
    return static_cast<int>(std::ranges::count(outcomes_, outcome));
}

QColor TrialStrip::colour_of(int outcome) const {
    const auto i = static_cast<size_t>(outcome);
    return outcome >= 0 && i < kinds_.size() ? kinds_[i].colour : legible("#808080");
}

QRectF TrialStrip::cell(size_t trial) const {
    const auto count = static_cast<double>(outcomes_.size());
    const double rows = std::clamp(std::ceil(count * kLeastCell / width()), 1.0, 6.0);
    const double in_row = std::ceil(count / rows);
    const auto i = static_cast<double>(trial);
    const double row = std::floor(i / in_row);
    const double across = width() / in_row, down = strip_height() / rows;
    return {(i - row * in_row) * across, row * down, across, down};
}

void TrialStrip::paintEvent(QPaintEvent*) {
    if (!plan_) return;
    QPainter painter(this);
    const QColor ink = palette().color(QPalette::WindowText);
    QColor faint = ink;
    faint.setAlpha(40);
    for (size_t i = 0; i < outcomes_.size(); ++i) {
        const QRectF place = cell(i);
        const double gap = place.width() > 4 ? 1 : 0.5;
        const QColor fill = outcomes_[i] == kNone ? faint : colour_of(outcomes_[i]);
        painter.fillRect(place.adjusted(0, 1, -gap, -1), fill);
        // in several rows, lines between blocks would be a pattern of their own
        const bool begins = cell(0).height() > strip_height() / 2.0 && i > 0 &&
                            plan_->trials[i].block != plan_->trials[i - 1].block;
        if (begins)
            painter.fillRect(QRectF(place.left() - 1, place.top(), 1.5, place.height()), ink);
    }
    if (current_ > 0 && static_cast<size_t>(current_) <= outcomes_.size()) {
        painter.setPen(QPen(ink, 2));
        painter.drawRect(cell(static_cast<size_t>(current_) - 1).adjusted(0, 1, 0, -1));
    }
    painter.setRenderHint(QPainter::Antialiasing);
    draw_legend(painter);
}

void TrialStrip::draw_legend(QPainter& painter) const {
    std::vector<ChartPainter::Entry> entries;
    for (size_t i = 0; i < kinds_.size(); ++i) {
        if (const int number = count(static_cast<int>(i)); number > 0)
            entries.push_back({QString("%1 %2").arg(kinds_[i].name).arg(number), kinds_[i].colour});
    }
    const ChartPainter chart(painter, *this, rect(), 0, 1, {0, 1, 1});
    chart.draw_legend(0, strip_height(), entries, ChartPainter::Mark::dot);
}

QString TrialStrip::describe(size_t trial) const {
    const task::Trial& is = plan_->trials[trial];
    const auto name = [](const auto& list, int which) {
        return static_cast<size_t>(which) < list.size()
                   ? QString::fromStdString(list[static_cast<size_t>(which)].name)
                   : QString();
    };
    QStringList words{tr("trial %1").arg(trial + 1), name(plan_->task.blocks, is.block),
                      name(plan_->task.conditions, is.condition),
                      name(plan_->outcomes, outcomes_[trial])};
    words.removeAll("");
    return words.join(" \u00b7 ");
}

bool TrialStrip::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip || !plan_) return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    for (size_t i = 0; i < outcomes_.size(); ++i) {
        if (!cell(i).contains(help->pos())) continue;
        QToolTip::showText(help->globalPos(), describe(i), this);
        return true;
    }
    QToolTip::hideText();
    return true;
}

}  // namespace dihaptic::gui
