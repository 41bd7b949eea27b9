// The panel with a row for each attempt at a trial that has ended, as they come.
#pragma once

#include <QTreeWidget>

#include "session/live.h"
#include "task/task_plan.h"

namespace dihaptic::gui {

class TrialsPanel : public QTreeWidget {
    Q_OBJECT

  public:
    explicit TrialsPanel(QWidget* parent = nullptr);

    /// A session of these trials begins; null: of none.
    void set_plan(std::shared_ptr<const task::TaskPlan> plan);
    void add(const session::TrialEnd& end);

  private:
    std::shared_ptr<const task::TaskPlan> plan_;
    std::vector<double> units_;  // of the columns of the task's own, in SI
};

}  // namespace dihaptic::gui
