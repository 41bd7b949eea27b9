#include "trials_panel.h"

#include <QHeaderView>
#include <QScrollBar>
#include <QSplitter>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "base/unit.h"
#include "task/levels.h"

namespace dihaptic::gui {
namespace {

struct Number {
    QString name;  ///< ends in its unit
    double si;     ///< that unit
};

constexpr int kSeconds = 5, kGrip = 6, kForce = 7, kOwn = 8;  // columns of numbers

/// The numbers that a task has of its own, in the order in which frames have them.
std::vector<Number> numbers_of(const task::TaskPlan& plan) {
    std::vector<Number> out;
    const auto add = [&](const std::string& name) {
        if (out.size() < session::TrialEnd::kNumbers)
            out.push_back({QString::fromStdString(name), split_unit(name).si});
    };
    for (const task::Variable& variable : plan.task.variables) add(variable.name);
    for (const task::LevelName& level : task::levels_of(plan.task)) add(level.name);
    for (const task::AskSpec& ask : task::questions_of(plan.task)) add(ask.name);
    return out;
}

}  // namespace

TrialsPanel::TrialsPanel(QWidget* parent)
    : QWidget(parent), chart_(new TrialChart), table_(new QTreeWidget) {
    table_->setAccessibleName(tr("Trials"));
    table_->setRootIsDecorated(false);
    table_->setUniformRowHeights(true);
    table_->header()->setSectionsClickable(true);
    table_->header()->setToolTip(tr("A click on a column of numbers shows it in the chart."));
    auto* parts = new QSplitter(Qt::Vertical);
    parts->addWidget(chart_);
    parts->addWidget(table_);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(parts);
    connect(table_->header(), &QHeaderView::sectionClicked, this, &TrialsPanel::chart);
    set_plan(nullptr);
}

void TrialsPanel::set_plan(std::shared_ptr<const task::TaskPlan> plan) {
    table_->clear();
    ends_.clear();
    plan_ = std::move(plan);
    QStringList names{tr("trial"),   tr("block"), tr("condition"), tr("attempt"),
                      tr("outcome"), "s",         tr("grip N"),    tr("force N")};
    units_.clear();
    if (plan_) {
        for (const Number& number : numbers_of(*plan_)) {
            names += number.name;
            units_.push_back(number.si);
        }
    }
    table_->setColumnCount(static_cast<int>(names.size()));
    table_->setHeaderLabels(names);
    for (int column = 0; column < table_->columnCount(); ++column)
        table_->resizeColumnToContents(column);
    // what the task itself counts or chooses, if it does
    chart(units_.empty() ? kSeconds : kOwn);
}

double TrialsPanel::value(const session::TrialEnd& end, int column) const {
    if (column == kSeconds) return end.stop - end.start;
    if (column == kGrip) return end.peak_grip;
    if (column == kForce) return end.peak_force;
    const auto own = static_cast<size_t>(column - kOwn);
    return end.numbers[own] / units_[own];
}

void TrialsPanel::chart(int column) {
    if (column < kSeconds) return;
    charted_ = column;
    QStringList outcomes;
    if (plan_) {
        for (const auto& outcome : plan_->outcomes)
            outcomes += QString::fromStdString(outcome.name);
    }
    const auto block_of = [&](const session::TrialEnd& end) {
        return plan_->trials[static_cast<size_t>(end.trial) - 1].block;
    };
    std::vector<TrialChart::Point> points;
    for (const session::TrialEnd& end : ends_) {
        const bool begins = !points.empty() && block_of(end) != block_of(ends_[points.size() - 1]);
        points.push_back({value(end, column), end.outcome, begins});
    }
    chart_->set_points(table_->headerItem()->text(column), outcomes, std::move(points));
}

void TrialsPanel::add(const session::TrialEnd& end) {
    if (!plan_ || end.trial < 1 || static_cast<size_t>(end.trial) > plan_->trials.size()) return;
    const task::Trial& trial = plan_->trials[static_cast<size_t>(end.trial) - 1];
    const auto name = [](const auto& list, int which) {
        return static_cast<size_t>(which) < list.size()
                   ? QString::fromStdString(list[static_cast<size_t>(which)].name)
                   : QString();
    };
    const auto number = [](double value, int decimals) {
        return std::isfinite(value) ? QString::number(value, 'f', decimals) : QString();
    };
    QStringList row{QString::number(end.trial),
                    name(plan_->task.blocks, trial.block),
                    name(plan_->task.conditions, trial.condition),
                    QString::number(end.attempt),
                    name(plan_->outcomes, end.outcome),
                    number(end.stop - end.start, 2),
                    number(end.peak_grip, 2),
                    number(end.peak_force, 2)};
    for (size_t i = 0; i < units_.size(); ++i) {
        const double value = end.numbers[i] / units_[i];
        row += std::isfinite(value) ? QString::number(value, 'g', 4) : QString();
    }
    auto* item = new QTreeWidgetItem(table_, row);
    ends_.push_back(end);
    chart(charted_);
    // who has scrolled back goes on looking there
    const QScrollBar* const bar = table_->verticalScrollBar();
    if (bar->value() >= bar->maximum() - 1) table_->scrollToItem(item);
    if (table_->topLevelItemCount() == 1) {
        for (int column = 0; column < table_->columnCount(); ++column)
            table_->resizeColumnToContents(column);
    }
}

}  // namespace dihaptic::gui
