// The panel with a row for each attempt at a trial that has ended, as they come, and a chart of one
// of its columns.
#pragma once

#include <QTreeWidget>

#include "session/live.h"
#include "task/task_plan.h"
#include "trial_chart.h"

namespace dihaptic::gui {

class TrialsPanel : public QWidget {
    Q_OBJECT

  public:
    explicit TrialsPanel(QWidget* parent = nullptr);

    /// A session of these trials begins; null: of none.
    void set_plan(std::shared_ptr<const task::TaskPlan> plan);
    void add(const session::TrialEnd& end);

  private:
    /// Shows a column of numbers in the chart.
    void chart(int column);
    double value(const session::TrialEnd& end, int column) const;

    std::shared_ptr<const task::TaskPlan> plan_;
    std::vector<double> units_;  // of the columns of the task's own, in SI
    TrialChart* chart_;
    QTreeWidget* table_;
    int charted_ = 0;                      // column
    std::vector<session::TrialEnd> ends_;  // a row each
};

}  // namespace dihaptic::gui
