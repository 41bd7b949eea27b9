#include "trials_panel.h"

#include <QHeaderView>
#include <QScrollBar>
#include <QSplitter>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "base/unit.h"
#include "column_words.h"
#include "outcomes.h"
#include "task/plan/levels.h"

namespace dihaptic::gui {
namespace {

struct Number {
    QString name;  ///< includes the unit at its end
    double si;     ///< that unit
};

enum Column { kTrial, kBlock, kCondition, kAttempt, kOutcome, kSeconds, kGrip, kForce, kOwn };

/// The task's own numbers, in the order in which a frame stores them.
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

/// The columns of trials.csv that the panel adds: the measures, which begin with `first`, and
/// before them the share of the perturbation, if a procedure chooses it.
std::vector<size_t> columns_of_figures(const Table& trials, size_t first,
                                       const task::TaskPlan& plan) {
    std::vector<size_t> out;
    const bool shares =
        std::ranges::any_of(plan.task.procedures, [](const auto& p) { return p.level.empty(); });
    const auto share = std::ranges::find(trials.columns, "share", &Table::Column::name);
    if (shares && share != trials.columns.end())
        out.push_back(static_cast<size_t>(share - trials.columns.begin()));
    for (size_t i = first; i < trials.columns.size(); ++i) out.push_back(i);
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
    connect(table_->header(), &QHeaderView::sectionClicked, this, [this](int column) {
        chosen_ = true;
        chart(column);
    });
    set_plan(nullptr);
}

void TrialsPanel::set_plan(std::shared_ptr<const task::TaskPlan> plan) {
    table_->clear();
    ends_.clear();
    figures_.clear();
    found_.clear();
    chosen_ = false;
    plan_ = std::move(plan);
    QStringList names{tr("trial"),   tr("block"),        tr("condition"),     tr("attempt"),
                      tr("outcome"), tr("duration [s]"), tr("peak grip [N]"), tr("peak force [N]")};
    units_.clear();
    if (plan_) {
        for (const Number& number : numbers_of(*plan_)) {
            names += column_words(number.name);
            units_.push_back(number.si);
        }
    }
    table_->setColumnCount(static_cast<int>(names.size()));
    table_->setHeaderLabels(names);
    arrange();
    // shows the first number that the task itself counts or chooses, if there is one
    chart(units_.empty() ? kSeconds : kOwn);
}

int TrialsPanel::own_columns() const {
    return kOwn + static_cast<int>(units_.size());
}

double TrialsPanel::value(size_t row, int column) const {
    const session::TrialEnd& end = ends_[row];
    if (column >= own_columns()) {
        const auto found = found_.find({end.trial, end.attempt});
        const auto i = static_cast<size_t>(column - own_columns());
        return found == found_.end() || i >= found->second.size() ? kUnmeasured : found->second[i];
    }
    if (column == kSeconds) return end.stop - end.start;
    if (column == kGrip) return end.peak_grip;
    if (column == kForce) return end.peak_force;
    const auto own = static_cast<size_t>(column - kOwn);
    return end.numbers[own] / units_[own];
}

void TrialsPanel::chart(int column) {
    if (column < kSeconds) return;
    charted_ = column;
    const auto outcomes = plan_ ? outcomes_of(*plan_) : std::vector<ChartPainter::Entry>();
    const auto block_of = [&](const session::TrialEnd& end) {
        return plan_->trials[static_cast<size_t>(end.trial) - 1].block;
    };
    std::vector<TrialChart::Point> points;
    for (size_t row = 0; row < ends_.size(); ++row) {
        const bool begins = row > 0 && block_of(ends_[row]) != block_of(ends_[row - 1]);
        points.push_back({value(row, column), ends_[row].outcome, begins});
    }
    Q_EMIT charted(table_->headerItem()->text(column), outcomes, points);
    chart_->set_points(table_->headerItem()->text(column), outcomes, std::move(points));
}

/// Whether a column says anything: it has a text, and not the same trivial one in each row.
bool TrialsPanel::tells(int column) const {
    for (size_t row = 0; row < ends_.size(); ++row) {
        const double number = column < kSeconds ? kUnmeasured : value(row, column);
        const QString text = table_->topLevelItem(static_cast<int>(row))->text(column);
        if (column == kAttempt  ? text != "1"
            : column < kSeconds ? !text.isEmpty()
                                : std::isfinite(number) && number != 0)
            return true;
    }
    return false;
}

/// Puts the columns that an operator follows first, hides those without values, and fits all to
/// their contents.
void TrialsPanel::arrange() {
    std::vector<int> order{kTrial, kBlock, kCondition, kOutcome};
    for (int column = own_columns(); column < table_->columnCount(); ++column)
        order.push_back(column);
    for (int column = kOwn; column < own_columns(); ++column) order.push_back(column);
    order.insert(order.end(), {kSeconds, kGrip, kForce, kAttempt});
    QHeaderView& header = *table_->header();
    for (size_t place = 0; place < order.size(); ++place) {
        header.moveSection(header.visualIndex(order[place]), static_cast<int>(place));
        const bool empty = !ends_.empty() && !tells(order[place]);
        table_->setColumnHidden(order[place],
                                empty || (ends_.empty() && order[place] >= own_columns()));
        table_->resizeColumnToContents(order[place]);
    }
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
    fill_in(ends_.size() - 1);
    chart(charted_);
    // if the user has scrolled back, the view does not move
    const QScrollBar* const bar = table_->verticalScrollBar();
    if (bar->value() >= bar->maximum() - 1) table_->scrollToItem(item);
    arrange();
}

void TrialsPanel::set_figures(const Table& trials) {
    const auto place = [&](const std::string& name) {
        const auto found = std::ranges::find(trials.columns, name, &Table::Column::name);
        return static_cast<size_t>(found - trials.columns.begin());
    };
    const size_t trial = place("trial_num"), attempt = place("attempt");
    const size_t shown = place("peak_force_N");  // already shown, like all columns before it
    if (!plan_ || trials.rows.empty() || std::max({trial, attempt, shown}) == trials.columns.size())
        return;
    const auto number = [](const Table::Cell& cell) {
        const double* const value = std::get_if<double>(&cell);
        return value == nullptr ? kUnmeasured : *value;
    };
    const std::vector<size_t> columns = columns_of_figures(trials, shown + 1, *plan_);
    for (const std::vector<Table::Cell>& row : trials.rows) {
        Figures& figures =
            found_[{static_cast<int>(number(row[trial])), static_cast<int>(number(row[attempt]))}];
        figures.clear();
        for (const size_t i : columns) figures.push_back(number(row[i]));
    }
    if (figures_.isEmpty()) name_figures(trials, columns);
    for (size_t row = 0; row < ends_.size(); ++row) fill_in(row);
    for (int i = 0; i < figures_.size(); ++i) {
        const int column = own_columns() + i;
        const auto has = [&](const auto& of) {
            return std::isfinite(of.second[static_cast<size_t>(i)]);
        };
        const bool any = std::ranges::any_of(found_, has);
        // a measure tells more than the duration
        if (any && !chosen_ && charted_ == kSeconds && !figures_[i].endsWith("_s"))
            charted_ = column;
    }
    arrange();
    chart(charted_);
}

/// Adds a column for each measured number.
void TrialsPanel::name_figures(const Table& trials, const std::vector<size_t>& columns) {
    for (const size_t i : columns) {
        const Table::Column& column = trials.columns[i];
        figures_ += QString::fromStdString(column.name);
        const int at = own_columns() + static_cast<int>(figures_.size()) - 1;
        table_->setColumnCount(at + 1);
        table_->headerItem()->setText(at, column_words(figures_.back()));
        table_->headerItem()->setToolTip(
            at, QString("%1: %2").arg(figures_.back(), QString::fromStdString(column.in_words())));
    }
}

void TrialsPanel::fill_in(size_t row) {
    QTreeWidgetItem* const item = table_->topLevelItem(static_cast<int>(row));
    for (int i = 0; i < figures_.size(); ++i) {
        const double now = value(row, own_columns() + i);
        item->setText(own_columns() + i, std::isfinite(now) ? QString::number(now, 'g', 4) : "");
    }
}

}  // namespace dihaptic::gui
