#include "trials_panel.h"

#include <QScrollBar>
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

TrialsPanel::TrialsPanel(QWidget* parent) : QTreeWidget(parent) {
    setAccessibleName("Trials");
    setRootIsDecorated(false);
    setUniformRowHeights(true);
    set_plan(nullptr);
}

void TrialsPanel::set_plan(std::shared_ptr<const task::TaskPlan> plan) {
    clear();
    plan_ = std::move(plan);
    QStringList names{"trial",   "block", "condition", "attempt",
                      "outcome", "s",     "grip N",    "force N"};
    units_.clear();
    if (plan_) {
        for (const Number& number : numbers_of(*plan_)) {
            names += number.name;
            units_.push_back(number.si);
        }
    }
    setColumnCount(static_cast<int>(names.size()));
    setHeaderLabels(names);
    for (int column = 0; column < columnCount(); ++column) resizeColumnToContents(column);
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
    auto* item = new QTreeWidgetItem(this, row);
    // who has scrolled back goes on looking there
    const QScrollBar* const bar = verticalScrollBar();
    if (bar->value() >= bar->maximum() - 1) scrollToItem(item);
    if (topLevelItemCount() == 1) {
        for (int column = 0; column < columnCount(); ++column) resizeColumnToContents(column);
    }
}

}  // namespace dihaptic::gui
