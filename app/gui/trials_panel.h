// The panel that lists the finished trial attempts, one per row, adds the measures of each a moment
// later, and plots one of the columns.
#pragma once

#include <QTreeWidget>
#include <map>
#include <utility>

#include "base/table.h"
#include "session/listeners/live.h"
#include "task/plan/task_plan.h"
#include "trial_chart.h"

namespace dihaptic::gui {

class TrialsPanel : public QWidget {
    Q_OBJECT

  public:
    explicit TrialsPanel(QWidget* parent = nullptr);

    /// Called when a session with these trials starts; null for a session without trials.
    void set_plan(std::shared_ptr<const task::TaskPlan> plan);
    void add(const session::TrialEnd& end);
    /// Fills in the measures of the attempts. `trials`: a table in the form of trials.csv.
    void set_figures(const Table& trials);

  Q_SIGNALS:
    /// The chart shows these numbers, one for each attempt. `name`: in words, with the unit.
    void charted(const QString& name,
                 const std::vector<dihaptic::gui::ChartPainter::Entry>& outcomes,
                 const std::vector<dihaptic::gui::TrialChart::Point>& points);

  private:
    /// The measures of an attempt.
    using Figures = std::vector<double>;

    /// Plots a column of numbers in the chart.
    void chart(int column);
    double value(size_t row, int column) const;
    void name_figures(const Table& trials, const std::vector<size_t>& columns);
    void fill_in(size_t row);
    int own_columns() const;
    bool tells(int column) const;
    void arrange();

    std::shared_ptr<const task::TaskPlan> plan_;
    std::vector<double> units_;  // SI units of the task's own columns
    TrialChart* chart_;
    QTreeWidget* table_;
    int charted_ = 0;                               // column
    bool chosen_ = false;                           // whether the user clicked to choose the column
    std::vector<session::TrialEnd> ends_;           // one item for each row
    QStringList figures_;                           // names of the columns after those of the task
    std::map<std::pair<int, int>, Figures> found_;  // measures by trial and attempt
};

}  // namespace dihaptic::gui
