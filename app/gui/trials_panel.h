// The panel with a row for each finished attempt at a trial, with its measures a moment later, and
// a chart of one of the columns.
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

    /// A session with these trials starts; null: a session without trials.
    void set_plan(std::shared_ptr<const task::TaskPlan> plan);
    void add(const session::TrialEnd& end);
    /// Fills in the measures of these attempts. `trials`: as in trials.csv.
    void set_figures(const Table& trials);

  private:
    /// The measures of an attempt.
    using Figures = std::vector<double>;

    /// Shows a column of numbers in the chart.
    void chart(int column);
    double value(size_t row, int column) const;
    void name_figures(const Table& trials, size_t first);
    void fill_in(size_t row);
    int own_columns() const;

    std::shared_ptr<const task::TaskPlan> plan_;
    std::vector<double> units_;  // units of the task's own columns, in SI
    TrialChart* chart_;
    QTreeWidget* table_;
    int charted_ = 0;                               // column
    bool chosen_ = false;                           // whether by a click
    std::vector<session::TrialEnd> ends_;           // one for each row
    QStringList figures_;                           // names of the columns after the task's own
    std::map<std::pair<int, int>, Figures> found_;  // measures by trial and attempt
};

}  // namespace dihaptic::gui
